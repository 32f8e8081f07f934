// Symbols of supports, springs, hinges and forces, in pixels, at a point (x, y) of the drawing.

function path(pen, points, close) {
  pen.beginPath();
  points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  if (close) pen.closePath();
}

function disc(pen, x, y, radius) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
}

function filled(pen, fill) {
  pen.fillStyle = fill;
  pen.fill();
  pen.stroke();
}

function hatching(pen, x, y, half) {
  path(pen, [[x - half, y], [x + half, y]]);
  pen.stroke();
  for (let i = -half; i < half; i += 5) {
    path(pen, [[x + i + 4, y], [x + i, y + 5]]);
    pen.stroke();
  }
}

function drawSupport(pen, kind, x, y, fill) {
  if (kind === "pinned") {
    path(pen, [[x, y], [x + 8, y + 13], [x - 8, y + 13]], true);
    filled(pen, fill);
    hatching(pen, x, y + 13, 12);
  } else if (kind === "roller") {
    disc(pen, x, y + 6.5, 6.5);
    filled(pen, fill);
    hatching(pen, x, y + 13, 12);
  } else if (kind === "clamped") {
    pen.beginPath();
    pen.rect(x - 6, y - 2, 12, 15);
    filled(pen, fill);
    hatching(pen, x, y + 13, 12);
  } else if (kind === "guided" || kind === "along") {
    path(pen, [[x, y], [x + 7, y + 7], [x, y + 14], [x - 7, y + 7]], true);
    filled(pen, fill);
  }
}

function drawJoint(pen, joint, x, y, fill) {
  if (joint === "hinge") {
    disc(pen, x, y, 4);
    filled(pen, fill);
  } else if (joint === "separate") {
    for (const side of [-2, 2]) {
      path(pen, [[x + side, y - 7], [x + side, y + 6]]);
      pen.stroke();
    }
  } else if (joint === "crack") {
    path(pen, [[x - 2, y + 6], [x + 2, y + 2], [x - 2, y - 2], [x + 2, y - 6]]);
    pen.stroke();
  }
}

// A zigzag from one point to another.
function drawZigzag(pen, x1, y1, x2, y2, side, turns) {
  const length = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [nx, ny] = [(-(y2 - y1) / length) * side, ((x2 - x1) / length) * side];
  const points = [[x1, y1]];
  for (let i = 0; i < turns; ++i) {
    const part = 0.15 + (0.7 * (i + 0.5)) / turns;
    const sign = i % 2 ? -1 : 1;
    points.push([x1 + part * (x2 - x1) + sign * nx, y1 + part * (y2 - y1) + sign * ny]);
  }
  points.push([x2, y2]);
  path(pen, points);
  pen.stroke();
}

// A spring of the bridge; below a gap it begins lower, with a plate.
function drawSpring(pen, kind, x, top, gap) {
  const y = gap ? top + 7 : top;
  if (gap) {
    path(pen, [[x - 6, y], [x + 6, y]]);
    pen.stroke();
  }
  if (kind === "vertical") {
    drawZigzag(pen, x, y, x, y + 17, 4, 6);
    hatching(pen, x, y + 17, 7);
  } else if (kind === "longitudinal") {
    drawZigzag(pen, x, y + 6, x + 19, y + 6, 4, 6);
    path(pen, [[x + 19, y], [x + 19, y + 12]]);
    pen.stroke();
  } else {
    pen.beginPath();
    for (let i = 0; i <= 40; ++i) {
      const radius = 1.5 + (5 * i) / 40;
      const angle = (4 * Math.PI * i) / 40;
      pen.lineTo(x + radius * Math.cos(angle), y + 7 + radius * Math.sin(angle));
    }
    pen.stroke();
  }
}

// An arrow down to (x, y).
function drawArrow(pen, x, y, height) {
  path(pen, [[x, y - height], [x, y]]);
  pen.stroke();
  path(pen, [[x, y], [x - 3, y - 7], [x + 3, y - 7]], true);
  pen.fill();
}
