// Charts: curves with values under the pointer, legend, zoom by dragging, and a line at the instant of the drawing.

const DASHES = [[], [7, 4], [2, 3]];
const NAMES = ["", "dashed", "dotted"];
const FAR = 2.5; // times the greatest value: limits above it are named at the edge
// Ticks with narrow spaces between thousands, as all numbers of the page.
const GROUPED = {
  format: { useGrouping: false },
  callback(value, ...more) {
    return Math.abs(value) < 1e4 ? Chart.Ticks.formatters.numeric.call(this, value, ...more) : digits(value);
  },
};

// The points under the pointer: of each visible curve the one with the nearest x.
Chart.Interaction.modes.nearestX = (chart, event) => {
  const wanted = chart.scales.x.getValueForPixel(event.x);
  return chart.data.datasets.flatMap((dataset, datasetIndex) => {
    if (!chart.isDatasetVisible(datasetIndex) || !dataset.xs.length || dataset.silent) return [];
    const index = nearest(dataset.xs, wanted);
    return [{ element: chart.getDatasetMeta(datasetIndex).data[index], datasetIndex, index }];
  });
};

class ChartCard {
  // spec: title, unit, xName, xUnit, curves [{name, columns, x, runs, points}], x, limits, samples.
  constructor(parent, spec, actions = {}) {
    this.spec = spec;
    this.actions = actions;
    this.root = element("figure", "card");
    this.root.style.margin = "0";
    const title = element("div", "row-head");
    this.reset = element("button", "", said("reset"));
    this.reset.type = "button";
    this.reset.hidden = true;
    this.reset.addEventListener("click", () => this.zoom(null));
    title.append(element("h3", "", spec.title + (spec.unit ? ` (${spec.unit})` : "")), this.reset);
    this.plot = element("div", "plot");
    this.canvas = element("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${spec.title}, ${spec.xName}`);
    this.cursor = element("div", "cursor");
    this.chosen = element("div", "chosen");
    this.cursor.hidden = this.chosen.hidden = true;
    this.plot.append(this.canvas, this.cursor, this.chosen);
    this.legend = element("div", "legend");
    this.root.append(title, this.plot, this.legend);
    if (spec.samples && spec.samples[0] < spec.samples[1]) {
      const [count, all] = spec.samples;
      this.root.append(element("div", "chart-foot", said("samples", { count, all })));
    }
    parent.append(this.root);
    this.chart = new Chart(this.canvas, this.config());
    this.addEdges();
    this.addLegend();
    addGestures(this);
  }

  datasets() {
    const found = [];
    const bands = this.spec.curves.filter((curve) => curve.columns.length > 1);
    this.filled = bands.length < 4; // more bands are drawn as lines
    this.spec.curves.forEach((curve, number) => {
      const xs = curve.x || this.spec.x;
      const few = xs.length <= 15 || curve.points;
      curve.columns.forEach((values, side) => {
        found.push({
          label: curve.name, curve: number, xs, runs: curve.runs,
          data: Array.from(xs, (x, i) => ({ x, y: values[i] })),
          order: curve.columns.length, showLine: !curve.points, tension: 0, borderWidth: 1.6,
          borderDash: DASHES[Math.floor(number / 6) % 3],
          pointRadius: few ? 2.5 : 0, pointHitRadius: 6, pointHoverRadius: 4, fill: side && this.filled ? "-1" : false,
        });
      });
    });
    const x = this.spec.x || this.spec.curves.flatMap((curve) => Array.from(curve.x));
    const ends = [x.reduce((a, b) => Math.min(a, b), Infinity), x.reduce((a, b) => Math.max(a, b), -Infinity)];
    this.ends = this.spec.range || (ends[0] < ends[1] ? ends : [ends[0] - 0.5, ends[0] + 0.5]);
    this.beyond = (this.spec.limits || []).filter(([, value]) => this.isFar(value, found));
    for (const [name, value] of (this.spec.limits || []).filter((limit) => !this.beyond.includes(limit))) {
      found.push({
        label: name, limit: true, silent: true, xs: this.ends, data: this.ends.map((at) => ({ x: at, y: value })),
        borderDash: [8, 4], borderWidth: 1.6, pointRadius: 0,
      });
    }
    this.mark = {
      label: said("chosen"), silent: true, xs: [], data: [], showLine: false, pointRadius: 7, pointBorderWidth: 2.5,
    };
    found.push(this.mark);
    return found;
  }

  // Whether a limit is so far from all values that its line would flatten the curves.
  isFar(limit, datasets) {
    const values = datasets.flatMap((one) => one.data.map(({ y }) => y)).filter(Number.isFinite);
    const side = values.reduce((most, value) => Math.max(most, Math.sign(limit) * value), 0);
    return Math.abs(limit) > FAR * side;
  }

  // Names the limits beyond the axis above or below the plot, where they are.
  addEdges() {
    for (const [name, value] of this.beyond) {
      const words = said("beyond", { limits: `${name}: ${ofQuantity(this.spec.quantity, value, this.spec.unit)}` });
      this.plot[value > 0 ? "before" : "after"](element("div", "edge", `${value > 0 ? "↑" : "↓"} ${words}`));
    }
  }

  // The values of deflections over the span are written at the axis as L/600.
  ticks() {
    const overSpan = ofQuantity(this.spec.quantity, 1, "").startsWith("L/");
    return { maxTicksLimit: 7, ...GROUPED, ...(overSpan && { callback: (value) => ofQuantity(this.spec.quantity, value, "") }) };
  }

  config() {
    const { spec } = this;
    const words = (item) => `${item.dataset.label}: ${ofQuantity(spec.quantity, item.parsed.y, spec.unit)}`;
    return {
      type: "line",
      data: { datasets: this.datasets() },
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
        interaction: { mode: "nearestX", intersect: false },
        layout: { padding: { right: 6, top: 4 } },
        scales: {
          x: {
            type: "linear", min: this.ends[0], max: this.ends[1],
            ticks: { maxRotation: 0, autoSkipPadding: 16, includeBounds: false, ...GROUPED },
            title: { display: true, text: spec.xUnit ? `${spec.xName} (${spec.xUnit})` : spec.xName, padding: 0 },
          },
          y: { grace: "4%", ticks: this.ticks(), beginAtZero: Boolean(spec.fromZero) },
        },
        plugins: {
          legend: { display: false },
          decimation: { enabled: false },
          tooltip: {
            displayColors: true, boxPadding: 4, itemSort: (a, b) => b.parsed.y - a.parsed.y, caretSize: 0,
            filter: (item, i, items) => items.length <= 14 || i < 14,
            callbacks: {
              title: (items) => (items.length ? `${spec.xName} ${withUnit(items[0].parsed.x, spec.xUnit)}` : ""),
              label: words,
            },
          },
        },
      },
    };
  }

  addLegend() {
    this.values = this.spec.curves.map((curve, number) => {
      const button = element("button");
      button.type = "button";
      button.setAttribute("aria-pressed", "true");
      const band = curve.columns.length > 1 && this.filled ? " band" : "";
      const swatch = element("span", `swatch ${NAMES[Math.floor(number / 6) % 3]}${band}`);
      const value = element("span", "value");
      button.append(swatch, document.createTextNode(curve.name), value);
      button.addEventListener("click", () => this.toggle(number, button));
      this.legend.append(button);
      return { value, swatch };
    });
    this.paint();
  }

  // Colours by the light or dark scheme of the browser.
  paint() {
    const limits = (this.spec.limits || []).length - this.beyond.length;
    this.chart.data.datasets.forEach((dataset) => {
      const name = dataset.limit ? "broken" : dataset === this.mark ? "text" : `curve${dataset.curve % 6}`;
      const own = colour(name);
      dataset.borderColor = dataset.pointBackgroundColor = dataset.pointBorderColor = own;
      if (dataset === this.mark) dataset.pointBackgroundColor = "transparent";
      if (this.spec.curves[dataset.curve]?.columns.length > 1) {
        dataset.backgroundColor = `${own}33`;
        dataset.borderWidth = this.filled ? 0.8 : 1.4;
      }
    });
    this.values.forEach(({ swatch }, number) => {
      swatch.style.borderColor = colour(`curve${number % 6}`);
    });
    if (limits && !this.limitSwatch) {
      this.limitSwatch = element("span", "chart-foot");
      this.limitSwatch.append(element("span", "swatch dashed"), document.createTextNode(said("limit")));
      this.legend.append(this.limitSwatch);
    }
    if (limits) this.limitSwatch.firstChild.style.borderColor = colour("broken");
    const { scales, plugins } = this.chart.options;
    for (const scale of [scales.x, scales.y]) {
      scale.grid = { color: colour("line"), borderColor: colour("line") };
      scale.ticks.color = colour("soft");
    }
    scales.x.title.color = colour("soft");
    Object.assign(plugins.tooltip, {
      backgroundColor: colour("card"), titleColor: colour("soft"), bodyColor: colour("text"), borderColor: colour("soft"),
      borderWidth: 1,
    });
    this.chart.update("none");
  }

  toggle(number, button) {
    const shown = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(shown));
    this.chart.data.datasets.forEach((dataset, i) => {
      if (dataset.curve === number) this.chart.setDatasetVisibility(i, shown);
    });
    this.chart.update("none");
  }

  // Moves the line of the instant; the chart itself is not drawn again.
  setCursor(x) {
    this.at = x;
    const { chartArea, scales } = this.chart;
    const px = scales.x.getPixelForValue(x);
    this.cursor.hidden = !chartArea || px < chartArea.left - 0.5 || px > chartArea.right + 0.5;
    if (this.cursor.hidden) return;
    this.cursor.style.top = `${chartArea.top}px`;
    this.cursor.style.height = `${chartArea.bottom - chartArea.top}px`;
    this.cursor.style.transform = `translateX(${px - 0.75}px)`;
  }

  // Writes the values at x beside the names.
  writeValues(x) {
    const i = nearest(this.spec.x, x);
    this.spec.curves.forEach((curve, number) => {
      const [low, high] = curve.columns;
      this.values[number].value.textContent = high ? `${digits(low[i])} … ${digits(high[i])}` : digits(low[i]);
    });
  }

  zoom(range) {
    this.reset.hidden = !range || Boolean(this.actions.zoom); // charts over time have a common button
    const { x } = this.chart.options.scales;
    [x.min, x.max] = range || this.ends;
    this.chart.update("none");
    if (this.at !== undefined) this.setCursor(this.at);
  }
}
