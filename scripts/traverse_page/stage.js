// The drawing at an instant: bridge, supports, vehicles and forces.

class Stage extends Places {
  constructor(canvas, stage) {
    super(canvas, stage);
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  draw(time) {
    this.time = time;
    this.between(time);
    const { view, middles, low } = this.stage;
    this.left = clamp(this.mixed(middles, 1, 0) - 0.5 * this.width, view.left, view.right - this.width);
    if (this.width > view.right - view.left) this.left = 0.5 * (view.left + view.right - this.width);
    const pen = this.canvas.getContext("2d");
    this.pen = pen;
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, this.wide, this.high);
    pen.lineJoin = "round";
    this.ink = colour("ink");
    this.fill = colour("card");
    this.drawScale();
    if (low !== null) this.drawBridge();
    else if (this.stage.ground) this.drawGround(this.left, this.left + this.width);
    this.drawn = this.stage.vehicles.map((vehicle) => this.drawVehicle(vehicle));
    this.drawForces();
  }

  drawGround(from, to) {
    const { pen } = this;
    pen.strokeStyle = colour("soft");
    pen.lineWidth = 2;
    path(pen, [[this.x(from), this.y(0)], [this.x(to), this.y(0)]]);
    pen.stroke();
  }

  drawScale() {
    const { pen } = this;
    const wanted = (90 * this.width) / this.wide;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const step = [1, 2, 5, 10].find((one) => one * power >= wanted) * power;
    pen.fillStyle = pen.strokeStyle = colour("soft");
    pen.lineWidth = 1;
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center";
    for (let i = Math.ceil(this.left / step); i * step <= this.left + this.width; ++i) {
      const x = this.x(i * step);
      path(pen, [[x, this.high - 22], [x, this.high - 17]]);
      pen.stroke();
      const words = `${digits(i * step)} m`;
      if (x > 20 && x < this.wide - 20) pen.fillText(words, x, this.high - 6);
    }
  }

  drawBridge() {
    const { pen } = this;
    const { low, high, line, supports, springs, hinges, cracks, rail, factor } = this.stage;
    if (low > this.left) this.drawGround(this.left, low);
    if (high < this.left + this.width) this.drawGround(high, this.left + this.width);
    const deck = rail ? 8 : 0; // pixels from the running surface to the line of the deck
    const seen = (x) => x > this.left - 1 && x < this.left + this.width + 1;
    const lies = (x) => this.y(factor * this.deflection(x)) + deck;
    pen.strokeStyle = this.ink;
    pen.lineWidth = 1.2;
    for (const [x, kind, gap] of springs) if (seen(x)) drawSpring(pen, kind, this.x(x), lies(x) + 3, gap);
    for (const [x, kind] of supports) if (seen(x)) drawSupport(pen, kind, this.x(x), lies(x) + 3, this.fill);
    if (rail) this.drawTrack(lies, deck);
    pen.strokeStyle = colour("soft");
    pen.lineWidth = 1;
    pen.setLineDash([6, 5]);
    path(pen, [[this.x(low), this.y(0) + deck], [this.x(high), this.y(0) + deck]]);
    pen.stroke();
    pen.setLineDash([]);
    pen.strokeStyle = colour("bridge");
    (line ? line.tracks : [null]).forEach((_, track) => {
      pen.lineWidth = track === 0 ? 4 : 1.5;
      path(pen, line ? this.pointsOf(track, deck) : [[this.x(low), this.y(0) + deck], [this.x(high), this.y(0) + deck]]);
      pen.stroke();
    });
    pen.strokeStyle = this.ink;
    pen.lineWidth = 1.2;
    for (const [x, , joint] of supports) if (seen(x)) drawJoint(pen, joint, this.x(x), lies(x), this.fill);
    for (const x of hinges) drawJoint(pen, "hinge", this.x(x), lies(x), this.fill);
    for (const x of cracks) drawJoint(pen, "crack", this.x(x), lies(x), this.fill);
  }

  // The points in sight of the deflected line of a track.
  pointsOf(track, deck) {
    const { line, factor } = this.stage;
    const points = [];
    const start = Math.max(lastNotAbove(line.x, this.left) - 1, 0);
    for (let i = start; i < line.x.length && line.x[i] <= this.left + 1.02 * this.width; ++i) {
      const w = this.deflectionAt(i, track);
      if (!Number.isNaN(w)) points.push([this.x(line.x[i]), this.y(factor * w) + deck]);
    }
    return points;
  }

  // The rail on its sleepers, as a symbol of the track.
  drawTrack(lies, deck) {
    const { pen } = this;
    pen.strokeStyle = colour("soft");
    pen.lineWidth = 1.5;
    const rail = [];
    for (let px = 0; px <= this.wide; px += 9) {
      const y = lies(this.left + px / this.scale) - deck;
      rail.push([px, y]);
      path(pen, [[px, y + 1], [px, y + deck - 2]]);
      pen.stroke();
    }
    path(pen, rail);
    pen.stroke();
  }

  // Draws a vehicle; returns the positions of its bodies.
  drawVehicle(vehicle) {
    const { pen } = this;
    const bodies = vehicle.bodies.map((_, body) => {
      const [x, y, turn] = this.position(vehicle, body);
      return [x, y, turn - vehicle.turns[body]];
    });
    const places = bodies.map(([x]) => x);
    if (Math.max(...places) < this.left - 30 || Math.min(...places) > this.left + this.width + 30) return bodies;
    const fill = colour("body");
    for (const part of this.stage.types[vehicle.type]) {
      const points = part.points.map((point) => {
        const [x, y] = this.placed(vehicle, bodies, point);
        return [this.x(x), this.y(y)];
      });
      this.drawPart(part, points, fill);
    }
    return bodies;
  }

  drawPart(part, points, fill) {
    const { pen } = this;
    const [[x, y], [x2, y2] = [0, 0]] = points;
    pen.strokeStyle = this.ink;
    pen.lineWidth = 1.2;
    if (part.is === "wheel") {
      disc(pen, x, y, Math.max(part.radius * this.scale, 1.5));
      filled(pen, this.fill);
    } else if (part.is === "body" && points.length === 1) {
      disc(pen, x, y, 5);
      filled(pen, fill);
    } else if (part.is === "body" && points.length === 2) {
      pen.lineWidth = 7;
      pen.lineCap = "round";
      path(pen, points);
      pen.stroke();
      pen.strokeStyle = fill;
      pen.lineWidth = 5;
      pen.stroke();
      pen.lineCap = "butt";
    } else if (part.is === "body") {
      path(pen, points, true);
      filled(pen, fill);
    } else if (part.is === "spring") {
      pen.strokeStyle = colour("force");
      const length = Math.hypot(x2 - x, y2 - y);
      if (length > 4) drawZigzag(pen, x, y, x2, y2, Math.min(4, 0.25 * length), clamp(Math.round(length / 9), 6, 24));
    } else if (part.is === "pin") {
      if (part.ground) hatching(pen, x, y + 9, 9);
      disc(pen, x, y, 3);
      filled(pen, this.fill);
    } else {
      path(pen, points);
      pen.stroke();
    }
  }

  drawForces() {
    const { pen } = this;
    const { forces, factor } = this.stage;
    const load = forces[this.train];
    if (!load) return;
    const largest = load.sizes.reduce((most, size) => Math.max(most, Math.abs(size)), 0) || 1;
    pen.strokeStyle = pen.fillStyle = colour("force");
    pen.lineWidth = 1.5;
    load.sizes.forEach((size, i) => {
      const place = this.mixed(load.x, load.sizes.length, i);
      const x = this.x(place);
      const foot = this.y(factor * this.deflection(place)) - 3;
      if (x > -5 && x < this.wide + 5) drawArrow(pen, x, foot, 12 + (34 * Math.abs(size)) / largest);
    });
  }
}
