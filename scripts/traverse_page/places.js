// Where everything is in the drawing at an instant. Lengths are in m, the drawing is in pixels.

class Places {
  constructor(canvas, stage) {
    this.canvas = canvas;
    this.stage = stage;
    this.time = stage.time[0];
    this.train = 0; // which of several trains of moving forces
    this.width = stage.view.width;
  }

  // Scale and size of the canvas for the present width of the page.
  resize() {
    const { view, line, low } = this.stage;
    const wide = this.canvas.parentElement.clientWidth;
    const needed = low === null ? 16 : 36; // symbols below the bridge, and the scale
    this.below = needed + 24;
    this.above = this.stage.forces.some((one) => one.sizes.length) ? 62 : 14;
    const most = clamp(0.42 * window.innerHeight, 240, 460) - this.below - this.above;
    const tall = Math.max(view.top - view.bottom, 1e-9);
    const narrow = wide < 560 && line ? Math.min(view.width, Math.max(60, wide / 5)) : view.width;
    this.scale = Math.min(wide / narrow, most / tall);
    this.width = wide / this.scale;
    this.wide = wide;
    this.high = Math.ceil(Math.max(tall * this.scale, 60) + this.above + this.below);
    this.ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(wide * this.ratio);
    this.canvas.height = Math.round(this.high * this.ratio);
    this.canvas.style.height = `${this.high}px`;
    this.zero = this.above + Math.max(tall * this.scale, 60) + view.bottom * this.scale;
    const room = this.high + 70 < 0.5 * window.innerHeight && wide > 860;
    this.canvas.parentElement.classList.toggle("pinned", room && this.stage.frames > 1 && !this.stage.travels);
    this.draw(this.time);
  }

  // The frames before and after an instant, and how far it is between them.
  between(time) {
    const { time: times, frames } = this.stage;
    const first = Math.min(lastNotAbove(times, time), Math.max(frames - 2, 0));
    const second = Math.min(first + 1, frames - 1);
    const gap = times[second] - times[first];
    this.first = first;
    this.second = second;
    this.part = gap > 0 ? clamp((time - times[first]) / gap, 0, 1) : 0;
  }

  // Lets the train of a sweep pass at a constant speed, m/s, from its start until it has left the bridge. Returns the
  // instant at which its front reaches the end of the bridge, s.
  travel(speed) {
    const { stage } = this;
    const { low, high, vehicles, middles } = stage;
    const load = stage.forces[this.train];
    const count = load ? load.sizes.length : 0;
    const starts = load ? Array.from(load.x.subarray(0, count)) : [];
    for (const { frames } of vehicles) for (let i = 0; i < frames.length; i += 6) starts.push(frames[i]);
    const [back, front] = [Math.min(...starts), Math.max(...starts)];
    const way = speed > 0 ? Math.max(high - back, 0) : Math.min(low - front, 0);
    for (let i = 0; i < count; ++i) load.x[count + i] = load.x[i] + way;
    for (const { frames } of vehicles) for (let i = 0; i < frames.length; i += 6) frames[i + 3] = frames[i] + way;
    const first = speed > 0 ? front : back;
    middles[0] = front - back > this.width ? first : 0.5 * (front + back);
    middles[1] = middles[0] + way;
    stage.time = Float32Array.of(0, way / speed);
    return clamp(((speed > 0 ? high : low) - first) / speed, 0, stage.time[1]);
  }

  mixed(values, stride, offset) {
    const before = values[this.first * stride + offset];
    return before + this.part * (values[this.second * stride + offset] - before);
  }

  x(place) {
    return (place - this.left) * this.scale;
  }

  y(height) {
    return this.zero - height * this.scale;
  }

  // Deflection of the drawn line of a track at its point with this index, m; NaN out of sight.
  deflectionAt(index, track = 0) {
    const { first, tracks, count } = this.stage.line;
    const values = tracks[track];
    const at = (frame) => {
      const i = index - first[frame];
      return i >= 0 && i < count ? values[frame * count + i] : NaN;
    };
    const [before, after] = [at(this.first), at(this.second)];
    return Number.isNaN(after) ? before : Number.isNaN(before) ? after : before + this.part * (after - before);
  }

  // Deflection of the bridge at a place, m; 0 beyond its ends.
  deflection(place) {
    const { line, low, high } = this.stage;
    if (!line || place < low || place > high) return 0;
    const i = Math.min(lastNotAbove(line.x, place), line.x.length - 2);
    const [before, after] = [this.deflectionAt(i), this.deflectionAt(i + 1)];
    return before + ((place - line.x[i]) / (line.x[i + 1] - line.x[i])) * (after - before) || 0;
  }

  // Position of a body: x, y, angle in m and rad, as in the results file.
  position(vehicle, body) {
    const offset = body * this.stage.frames * 3;
    const at = (column) => {
      const values = vehicle.frames;
      const before = values[offset + 3 * this.first + column];
      return before + this.part * (values[offset + 3 * this.second + column] - before);
    };
    return [at(0), at(1), at(2)];
  }

  // Where a point of a part is drawn, m.
  placed(vehicle, bodies, [body, x, y]) {
    if (body < 0) return [vehicle.origin[0] + x, vehicle.origin[1] + y];
    const [bx, by, turn] = bodies[body];
    const { factor } = this.stage;
    if (vehicle.free[body] || factor === 1) {
      const [c, s] = [Math.cos(turn), Math.sin(turn)];
      return [bx + c * x - s * y, by + (factor - 1) * this.deflection(bx) + s * x + c * y];
    }
    const height = vehicle.heights[body];
    return [bx + x, height + factor * (by - height + turn * x) + y];
  }
}
