// The pointer in a chart: dragging zooms, a click goes to an instant or chooses a run, a double click shows all again.

// The run whose visible point is the nearest one to a pixel of the chart.
function runAt({ chart }, px, py) {
  let best = { distance: Infinity };
  chart.data.datasets.forEach((dataset, i) => {
    if (!dataset.runs || !chart.isDatasetVisible(i)) return;
    chart.getDatasetMeta(i).data.forEach((point, index) => {
      const distance = Math.hypot(point.x - px, point.y - py);
      if (distance < best.distance) best = { distance, run: dataset.runs[index] };
    });
  });
  return best.run;
}

function addGestures(card) {
  const { plot, chart, chosen, actions } = card;
  const zoom = actions.zoom || ((range) => card.zoom(range));
  const place = (event) => {
    const box = plot.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const inside = (a, b) => {
    const { left, right } = chart.chartArea;
    return [clamp(Math.min(a, b), left, right), clamp(Math.max(a, b), left, right)];
  };
  let start = null;
  const end = () => {
    start = null;
    chosen.hidden = true;
  };
  plot.addEventListener("pointerdown", (event) => {
    if (event.button === 0) start = place(event);
  });
  plot.addEventListener("pointermove", (event) => {
    if (!start || !event.buttons) return;
    const [left, right] = inside(start[0], place(event)[0]);
    const { top, bottom } = chart.chartArea;
    chosen.hidden = right - left < 6;
    Object.assign(chosen.style, {
      top: `${top}px`, height: `${bottom - top}px`, width: `${right - left}px`, transform: `translateX(${left}px)`,
    });
  });
  plot.addEventListener("pointerup", (event) => {
    if (!start) return;
    const [x, y] = place(event);
    const [left, right] = inside(start[0], x);
    end();
    if (right - left >= 6) zoom([left, right].map((px) => chart.scales.x.getValueForPixel(px)));
    else if (actions.click) actions.click(card, x, y);
  });
  plot.addEventListener("pointercancel", end);
  plot.addEventListener("dblclick", () => zoom(null));
}
