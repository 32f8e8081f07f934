// Data of the page, numbers as texts, and small elements. Texts of the file become text nodes only, never HTML.

const DIGITS = 5;

function decoded(key, value) {
  if (!value || typeof value.f32 !== "string") return value;
  const bytes = Uint8Array.from(atob(value.f32), (letter) => letter.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

const data = JSON.parse(document.getElementById("data").textContent, decoded);

// A text of the page in its language; {name} stands for a part of it, a text or a number.
function said(name, parts = {}) {
  const text = (part) => (typeof part === "number" ? digits(part) : part);
  return data.words[name].replace(/\{(\w+)\}/g, (all, part) => text(parts[part]) ?? all);
}

// A number with five significant digits, a whole number with all; an empty text for an unknown one.
function digits(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "";
  const size = Math.abs(value);
  const exponential = !Number.isSafeInteger(value) && (size < 1e-4 || size >= 1e7);
  if (exponential) return value.toExponential(DIGITS - 1).replace(/\.?0+e\+?/, "e").replace(".", data.words.decimal);
  const [whole, part] = String(Number.isSafeInteger(value) ? value : Number(value.toPrecision(DIGITS))).split(".");
  const thousands = size < 1e4 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u202f"); // in groups from five digits on
  return part === undefined ? thousands : thousands + data.words.decimal + part;
}

function withUnit(value, unit) {
  return `${digits(value)}${unit && digits(value) ? ` ${unit}` : ""}`;
}

// A value of a quantity as text, a deflection over the span as L/600.
function ofQuantity(name, value, unit) {
  const overSpan = name && name.endsWith("deflection_over_span") && value > 0;
  return overSpan ? `L/${digits(Math.round(1 / value))}` : withUnit(value, unit);
}

function element(name, className, text) {
  const made = document.createElement(name);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

function byId(id) {
  return document.getElementById(id);
}

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

function clamp(value, low, high) {
  return Math.min(Math.max(value, low), Math.max(low, high));
}

// Index of the last value that is not above `wanted` in an ascending array, at least 0.
function lastNotAbove(values, wanted) {
  let low = 0;
  let high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= wanted) low = middle;
    else high = middle - 1;
  }
  return low;
}

// Index of the nearest value in an ascending array.
function nearest(values, wanted) {
  const at = lastNotAbove(values, wanted);
  return at + 1 < values.length && values[at + 1] - wanted < wanted - values[at] ? at + 1 : at;
}
