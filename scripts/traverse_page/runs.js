// Sweeps and studies: each quantity over the speed or the varied option, and the row of the chosen run.

class Runs {
  constructor(runs, stage) {
    this.runs = runs;
    this.stage = stage;
    byId("runs").hidden = false;
    const parts = [said("ended", { count: runs.finished, all: runs.count }), said("choose")];
    if (runs.lines.length > 1 && runs.lineNames) parts.push(said("differ", { names: runs.lineNames }));
    if (runs.lineNote) parts.push(runs.lineNote);
    if (runs.kept < runs.drawn) parts.push(said("someRuns", { count: runs.kept, all: runs.drawn }));
    byId("runs-note").textContent = parts.join(" ");
    this.charts = runs.quantities.map((quantity) => this.chartOf(quantity));
    this.profiles = runs.profiles.map((profile) => this.profileOf(profile));
    byId("run-back").addEventListener("click", () => this.step(-1));
    byId("run-forth").addEventListener("click", () => this.step(1));
    this.select(runs.first < 0 ? this.worst() : runs.first);
  }

  get cards() {
    return [...this.charts, ...this.profiles];
  }

  limitsOf(quantity) {
    return data.limits.filter((one) => one.quantity === quantity.name).map((one) => [`${said("limit")}, ${one.clause}`, one.limit]);
  }

  chartOf(quantity) {
    const { runs } = this;
    const [, xName, , xUnit] = /^(.*?)( \((.*)\))?$/.exec(runs.xLabel);
    const curves = runs.lines.map((line) => {
      const known = line.runs.filter((run) => Number.isFinite(quantity.values[run]));
      return {
        name: line.name, runs: known, points: runs.points,
        x: Float32Array.from(known, (run) => runs.x[run]),
        columns: [Float32Array.from(known, (run) => quantity.values[run])],
      };
    });
    const spec = {
      title: quantity.words, unit: quantity.unit, xName, xUnit: xUnit || "", curves, limits: this.limitsOf(quantity),
      fromZero: true, quantity: quantity.name,
    };
    return new ChartCard(byId("run-charts"), spec, {
      click: (card, x, y) => {
        const run = runAt(card, x, y);
        if (run !== undefined) this.select(run);
      },
    });
  }

  profileOf(profile) {
    const curves = [{ name: said("largest"), columns: [profile.largest] }];
    if (profile.runs) curves.push({ name: said("chosen"), columns: [new Float32Array(profile.x.length)] });
    return new ChartCard(byId("run-charts"), {
      title: profile.title, unit: profile.unit, xName: said("bridge"), xUnit: "m", x: profile.x, curves,
      fromZero: true,
    });
  }

  // The run with the least margin, otherwise that with the largest value of the first quantity.
  worst() {
    const { runs } = this;
    const [first] = runs.quantities;
    let [best, most] = [0, -Infinity];
    for (let run = 0; run < runs.kept; ++run) {
      const ratios = data.limits.map((one, i) => this.judged(run, i) / one.limit).filter(Number.isFinite);
      const value = ratios.length ? Math.max(...ratios) : first && !data.limits.length ? first.values[run] : NaN;
      if (value > most) [best, most] = [run, value];
    }
    return best;
  }

  judged(run, limit) {
    return this.runs.judged.length ? this.runs.judged[run * data.limits.length + limit] : NaN;
  }

  // The next run of the same curve.
  step(by) {
    const line = this.runs.lines.find((one) => one.runs.includes(this.run));
    if (!line) return;
    const at = line.runs.indexOf(this.run) + by;
    this.select(line.runs[clamp(at, 0, line.runs.length - 1)]);
  }

  select(run) {
    const { runs } = this;
    if (!runs.kept) return;
    this.run = run;
    const name = runs.names ? runs.names[run] : said("numbered", { number: run + 1 });
    byId("run-name").textContent = said("chosenRun", { run: name });
    const row = byId("run-row");
    row.textContent = "";
    const options = runs.parameters.map(({ name, unit, train, values }) =>
      [name, train ? `A${values[run]}` : withUnit(values[run], unit)]);
    const results = runs.quantities.map((one) => {
      const place = one.places[run];
      return [one.words, ofQuantity(one.name, one.values[run], one.unit), Number.isFinite(place) ? `${digits(place)} m` : ""];
    });
    row.append(tableOf([said("variedOption"), said("value")], options));
    row.append(tableOf([said("result"), said("value"), said("at")], results));
    const verdicts = data.limits.map((one, i) => this.verdictOf(run, one, i)).filter(Boolean);
    if (verdicts.length) row.append(tableOf([said("result"), said("requirement"), said("value"), said("limit")], verdicts));
    this.charts.forEach((card, i) => this.mark(card, runs.quantities[i].values[run]));
    this.profiles.forEach((card, i) => this.showProfile(card, runs.profiles[i]));
    this.showTrain();
  }

  verdictOf(run, limit, i) {
    const value = this.judged(run, i);
    if (!Number.isFinite(value)) return null;
    const word = value > limit.limit ? "broken" : "kept";
    return [word, `${limit.words}, ${limit.clause}`, ofQuantity(limit.quantity, value, limit.unit),
      ofQuantity(limit.quantity, limit.limit, limit.unit)];
  }

  mark(card, value) {
    card.mark.data = Number.isFinite(value) ? [{ x: this.runs.x[this.run], y: value }] : [];
    card.chart.update("none");
  }

  showProfile(card, profile) {
    if (!profile.runs) return;
    const points = profile.x.length;
    const { data: shown } = card.chart.data.datasets.find((dataset) => dataset.curve === 1);
    shown.forEach((point, i) => {
      point.y = profile.runs[this.run * points + i];
    });
    card.chart.update("none");
  }

  // The drawing shows the train of the chosen run, if the file has several, and its passage, if the file has its speed.
  showTrain() {
    const { stage, runs } = this;
    if (!stage) return;
    const train = runs.parameters.find((one) => one.train);
    const at = train ? stage.stage.forces.findIndex((one) => one.name === `A${train.values[this.run]}`) : -1;
    if (at >= 0) stage.train = at;
    if (runs.speeds) showPassage(stage.travel(runs.speeds[this.run]));
    else stage.draw(stage.time);
  }
}
