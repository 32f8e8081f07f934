// The page: heading, drawing with its time bar, charts, heat map, tables, keys.

const page = { time: 0, playing: false, cards: [], all: [] }; // `page` is also what the tests look at

function showHeading() {
  byId("title").textContent = data.title;
  byId("kind").textContent = data.kind;
  byId("said").textContent = data.said ? data.said[0].toUpperCase() + data.said.slice(1) : "";
  byId("about").textContent = data.about;
  const verdict = byId("verdict");
  [verdict.className, verdict.textContent] = data.verdict;
  verdict.hidden = byId("caveat").hidden = !verdict.textContent;
}

// Goes to an instant: drawing, lines in the charts, values, time bar.
function seek(time, writes = true) {
  page.time = clamp(time, page.start, page.end);
  page.stage.draw(page.time);
  page.cards.forEach((card) => {
    card.setCursor(page.time);
    if (writes) card.writeValues(page.time);
  });
  byId("bar").value = page.time;
  byId("clock").textContent = `${page.time.toFixed(page.decimals).replace(".", data.words.decimal)} s`;
  if (writes) byId("bar").setAttribute("aria-valuetext", byId("clock").textContent);
}

function play(on) {
  if (!page.stage || page.end <= page.start) return;
  page.playing = on;
  byId("play").classList.toggle("playing", on);
  byId("play").setAttribute("aria-label", said(on ? "pause" : "play"));
  if (!on) {
    seek(page.time);
    return;
  }
  if (page.time >= page.end) page.time = page.start;
  page.last = null;
  requestAnimationFrame(advance);
}

function advance(now) {
  if (!page.playing) return;
  const passed = page.last === null ? 0 : Math.min(now - page.last, 250) / 1000;
  page.last = now;
  page.count = (page.count || 0) + 1;
  seek(page.time + passed * page.rate, page.count % 8 === 0);
  if (page.time >= page.end) play(false);
  else requestAnimationFrame(advance);
}

function step(by) {
  play(false);
  const { time } = data.stage;
  seek(time[clamp(nearest(time, page.time) + by, 0, time.length - 1)]);
}

function zoom(range) {
  page.range = range;
  byId("reset").hidden = !range;
  page.cards.forEach((card) => card.zoom(range));
}

// Makes the visible time longer or shorter, about the instant of the drawing.
function zoomBy(factor) {
  const [low, high] = page.range || [page.start, page.end];
  const half = 0.5 * factor * (high - low);
  if (2 * half >= page.end - page.start) zoom(null);
  else zoom([-half, half].map((by) => clamp(page.time, page.start + half, page.end - half) + by));
}

// Speeds such that the whole run takes a quarter of a minute at first, as 1, 2, 5 times a power of ten.
function addSpeeds() {
  byId("speed").textContent = "";
  const wanted = (page.end - page.start) / 12;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const base = Math.min(power * [1, 2, 5].findLast((one) => one * power <= wanted * 1.0001), 1);
  page.rate = base;
  for (const times of [0.1, 0.2, 0.5, 1, 2, 5]) {
    const option = element("option", "", said("realTime", { factor: digits(base * times) }));
    option.value = base * times;
    option.selected = times === 1;
    byId("speed").append(option);
  }
}

// Gives the time bar and the speeds of playing the range of the drawing's time.
function showTime() {
  const { frames, time } = data.stage;
  [page.start, page.end] = [time[0], time[frames - 1]];
  page.decimals = clamp(Math.ceil(-Math.log10((page.end - page.start) / 2000)), 0, 6);
  [byId("bar").min, byId("bar").max] = [page.start, page.end];
  addSpeeds();
}

// Shows the passage of another run of a sweep at an instant.
function showPassage(time) {
  play(false);
  showTime();
  seek(time);
}

function showStage() {
  if (!data.stage) return;
  byId("stage").hidden = false;
  page.stage = new Stage(byId("drawing"), data.stage);
  const { frames, of, words, travels } = data.stage;
  const fewer = frames < of ? ` ${said("frames", { count: frames, all: of })}` : "";
  byId("drawn").textContent = words + fewer;
  byId("drawing").setAttribute("aria-label", `${said("drawing")}: ${words}`);
  showTime();
  if (frames < 2) return;
  byId("controls").hidden = false;
  byId("back").hidden = byId("forth").hidden = travels;
  const bar = byId("bar");
  bar.addEventListener("input", () => {
    if (page.playing) play(false);
    seek(Number(bar.value));
  });
  byId("play").addEventListener("click", () => play(!page.playing));
  byId("back").addEventListener("click", () => step(-1));
  byId("forth").addEventListener("click", () => step(1));
  byId("speed").addEventListener("change", (event) => {
    page.rate = Number(event.target.value);
  });
}

function showCharts() {
  const actions = { zoom, click: (card, x) => seek(card.chart.scales.x.getValueForPixel(x)) };
  page.cards = data.charts.map((spec) => new ChartCard(byId("time-charts"), spec, page.stage ? actions : { zoom }));
  byId("histories").hidden = !page.cards.length;
  const ofBridge = data.stage && data.stage.low !== null ? [data.stage.low, data.stage.high] : null;
  const along = data.along.map((spec) =>
    new ChartCard(byId("along-charts"), { ...spec, range: spec.xName === said("bridge") ? ofBridge : null }));
  byId("along").hidden = !along.length;
  byId("reset").addEventListener("click", () => zoom(null));
  if (data.heat) page.heat = new HeatMap(byId("heat"), data.heat);
  if (data.runs) page.runs = new Runs(data.runs, page.stage);
  page.all = [...page.cards, ...along, ...(page.runs ? page.runs.cards : [])];
  page.cards.forEach((card) => {
    card.chart.options.onResize = () => requestAnimationFrame(() => card.setCursor(page.time));
  });
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const name = event.target.tagName;
  if (name === "SELECT" || name === "TEXTAREA" || (name === "INPUT" && event.target.id !== "bar")) return;
  if (event.key === " " && (name === "BUTTON" || name === "SUMMARY")) return;
  if (event.key.startsWith("Arrow") && event.target.closest(".wide")) return; // scrolls the table
  const walks = page.stage && data.stage.frames > 1;
  const arrows = (by) => (page.runs ? page.runs.step(by) : walks && step(by));
  const keys = {
    " ": () => play(!page.playing), ArrowLeft: () => arrows(-1), ArrowRight: () => arrows(1),
    "+": () => walks && zoomBy(0.5), "-": () => walks && zoomBy(2), 0: () => zoom(null),
  };
  if (!keys[event.key] || (event.key === " " && !walks)) return;
  event.preventDefault();
  keys[event.key]();
}

Chart.defaults.locale = data.words.language;
showHeading();
showStage();
showCharts();
showTables();
if (page.stage && data.stage.frames > 1 && !data.stage.travels) seek(page.start);
document.addEventListener("keydown", onKey);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  if (page.stage) page.stage.draw(page.stage.time);
  page.all.forEach((card) => card.paint());
  if (page.heat) page.heat.paint();
});
