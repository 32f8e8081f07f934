// The heat map of a screen: a cell for each pair of bridge and formation, blue below 1 and red above it.

const MOST_NAMES = 40; // along an axis
const NAME_ROOM = 130; // pixels
const SHADES = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]]; // for 0, 0.5, 1, 1.5, 2

function shade(value) {
  const at = clamp(2 * value, 0, SHADES.length - 1);
  const low = Math.min(Math.floor(at), SHADES.length - 2);
  const mixed = SHADES[low].map((part, i) => Math.round(part + (at - low) * (SHADES[low + 1][i] - part)));
  return `rgb(${mixed.join(",")})`;
}

class HeatMap {
  constructor(place, spec) {
    this.spec = spec;
    this.canvas = element("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", spec.title);
    this.said = element("p", "note", said("point"));
    const card = element("div", "card");
    card.append(this.canvas, this.colourScale(), this.said);
    place.append(element("h2", "", spec.title), element("p", "note", spec.note), card);
    this.canvas.addEventListener("pointermove", (event) => this.point(event.offsetX, event.offsetY));
    new ResizeObserver(() => this.paint()).observe(card);
    this.paint();
  }

  // The colours from 0 to 2 with their values.
  colourScale() {
    const scale = element("div", "colour-scale");
    const stops = SHADES.map((_, i) => shade(i / 2));
    scale.style.backgroundImage = `linear-gradient(to right, ${stops.join(", ")})`;
    const values = element("div", "colour-scale-values");
    stops.forEach((_, i) => values.append(element("span", "", (i + 1 < stops.length ? "" : "≥ ") + digits(i / 2))));
    const both = element("div");
    both.append(element("p", "note", this.spec.label), scale, values);
    return both;
  }

  // Left and top edge of the cells, their width and height.
  layout() {
    const { rows, columns } = this.spec;
    this.left = rows.length <= MOST_NAMES ? NAME_ROOM : 0;
    this.top = columns.length <= MOST_NAMES ? NAME_ROOM : 0;
    this.width = (this.canvas.parentElement.clientWidth - 28 - this.left) / columns.length;
    this.height = clamp(420 / rows.length, rows.length <= MOST_NAMES ? 16 : 2, 28);
  }

  paint() {
    this.layout();
    const { rows, columns, values } = this.spec;
    const [width, height] = [this.left + this.width * columns.length, this.top + this.height * rows.length];
    const scale = window.devicePixelRatio || 1;
    [this.canvas.width, this.canvas.height] = [Math.round(scale * width), Math.round(scale * height)];
    [this.canvas.style.width, this.canvas.style.height] = [`${width}px`, `${height}px`];
    const pen = this.canvas.getContext("2d");
    pen.scale(scale, scale);
    for (let i = 0; i < values.length; i += 1) {
      if (Number.isFinite(values[i])) {
        pen.fillStyle = shade(values[i]);
        const [row, column] = [Math.floor(i / columns.length), i % columns.length];
        pen.fillRect(this.left + column * this.width, this.top + row * this.height, this.width, this.height);
      }
    }
    this.names(pen);
  }

  names(pen) {
    const { rows, columns } = this.spec;
    pen.fillStyle = colour("text");
    pen.font = '12px system-ui, "DejaVu Sans", sans-serif';
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    if (this.left) rows.forEach((name, i) => pen.fillText(name, this.left - 6, this.top + (i + 0.5) * this.height, this.left - 8));
    pen.textAlign = "left";
    columns.forEach((name, i) => {
      if (!this.top) return;
      pen.save();
      pen.translate(this.left + (i + 0.5) * this.width, this.top - 6);
      pen.rotate(-Math.PI / 2);
      pen.fillText(name, 0, 0, this.top - 8);
      pen.restore();
    });
  }

  // Says the pair below the pointer.
  point(x, y) {
    const { rows, columns, values, label } = this.spec;
    const [row, column] = [Math.floor((y - this.top) / this.height), Math.floor((x - this.left) / this.width)];
    const inside = row >= 0 && row < rows.length && column >= 0 && column < columns.length;
    const value = inside ? values[row * columns.length + column] : NaN;
    this.said.textContent = Number.isFinite(value) ? `${rows[row]}, ${columns[column]}: ${label} ${digits(value)}` : said("point");
  }
}
