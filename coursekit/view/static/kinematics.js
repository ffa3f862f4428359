// Kinematics in the page: where the links of an arm stand, from its screws. The same numbers as Robot.displacements in
// Python; so an arm follows its sliders in the next frame, also where no kernel runs.

/**
 * e^[S]q of a screw S = (w; v), |w| = 1 or w = 0: 16 numbers, column by column, as three.js keeps a matrix.
 * @param {number[]} S @param {number} q radians, or metres where w = 0
 */
export function exponential([wx, wy, wz, vx, vy, vz], q) {
  const s = Math.sin(q), half = Math.sin(q / 2), c = 2 * half * half; // c = 1 - cos q, exact for small q, too
  if (!wx && !wy && !wz) return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, vx * q, vy * q, vz * q, 1];
  const [ax, ay, az] = [wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx]; // w x v
  const along = (wx * vx + wy * vy + wz * vz) * (q - s);
  return [
    1 - c * (wy * wy + wz * wz), s * wz + c * wx * wy, -s * wy + c * wx * wz, 0,
    -s * wz + c * wx * wy, 1 - c * (wx * wx + wz * wz), s * wx + c * wy * wz, 0,
    s * wy + c * wx * wz, -s * wx + c * wy * wz, 1 - c * (wx * wx + wy * wy), 0,
    // (I q + (1 - cos q)[w] + (q - sin q)[w]^2) v, with [w]^2 v = w (w.v) - v
    s * vx + c * ax + along * wx, s * vy + c * ay + along * wy, s * vz + c * az + along * wz, 1,
  ];
}

/** The product of two transforms, column by column. @param {ArrayLike<number>} A @param {ArrayLike<number>} B */
export function product(A, B) {
  const C = new Array(16);
  for (let i = 0; i < 16; i += 1) {
    const row = i % 4, column = i - row;
    C[i] = A[row] * B[column] + A[4 + row] * B[column + 1] + A[8 + row] * B[column + 2] + A[12 + row] * B[column + 3];
  }
  return C;
}

/** Where the links went: e^[S1]q1 ... e^[Sk]qk, k = 1..n, 16 numbers each. @param {number[][]} screws @param {number[]} theta */
export function displacements(screws, theta) {
  let T = null;
  return screws.map((S, k) => (T = T ? product(T, exponential(S, theta[k])) : exponential(S, theta[k])));
}

/**
 * A line in words, as Scene.text in Python says it, for pages where no kernel does.
 * @param {{name: string, screws: number[][], M: number[]}} arm @param {number[]} theta
 */
export function describe({ name, screws, M }, theta) {
  const slides = screws.map(([wx, wy, wz]) => !wx && !wy && !wz);
  const round = (x) => { // as Python rounds: a tie goes to the even digit
    const near = Number(x.toFixed(7));
    const tie = Math.abs((4 * near) % 2) === 1;
    return (tie ? (2 * Math.round(5 * near)) / 10 : near).toFixed(1).replace(/^-(0\.0)$/, "$1");
  };
  const shown = theta.map((q, k) => round(q * (slides[k] ? 1000 : 180 / Math.PI)));
  const joints = slides.includes(true) ? `(${shown.map((x, k) => `${x} ${slides[k] ? "mm" : "deg"}`).join(", ")})` : `(${shown.join(", ")}) deg`;
  const tool = product(displacements(screws, theta).at(-1), M).slice(12, 15);
  return `${name}: joints ${joints}; tool at (${tool.map((x) => round(1000 * x)).join(", ")}) mm`;
}

/** The pose of a target from its six sliders: x, y, z, yaw, pitch, roll. @param {number[]} values metres and radians */
export function poseOf([x, y, z, yaw, pitch, roll]) {
  const turn = (axis, angle) => exponential([...axis, 0, 0, 0], angle);
  const R = product(product(turn([0, 0, 1], yaw), turn([0, 1, 0], pitch)), turn([1, 0, 0], roll));
  return [...R.slice(0, 12), x, y, z, 1];
}

/** x, y, z, yaw, pitch, roll of a pose, as rotations.zyx in Python gives the angles. @param {ArrayLike<number>} T */
export function valuesOf(T) {
  const level = Math.hypot(T[0], T[1]);
  const upright = level < 1e-9; // then only yaw - roll, or their sum, is known: the roll is taken to be 0
  const yaw = upright ? Math.atan2(-T[4], T[5]) : Math.atan2(T[1], T[0]);
  return [T[12], T[13], T[14], yaw, Math.atan2(-T[2], level), upright ? 0 : Math.atan2(T[6], T[10])];
}

/** T moved along (kind 0) or turned about (kind 1) its own axis k. @param {number[]} T @param {number} by metres, radians */
export function movedAlong(T, kind, k, by) {
  const axis = [0, 1, 2].map((i) => Number(i === k));
  return product(T, exponential(kind ? [...axis, 0, 0, 0] : [0, 0, 0, ...axis], by));
}

/**
 * Joint values that bring the tool nearer to its goal, by damped least squares; joints that are not free stay.
 * @param {{screws: number[][], M: number[]}} arm @param {number[]} theta @param {number[]} goal a point in metres, or a pose
 * @param {(number[] | null)[]} ends lowest and highest value of each free joint, null of the others
 * @returns {{q: number[], D: number[][], far: number}} how far it still is, in metres and, of a pose, radians
 */
export function reachFor({ screws, M }, theta, goal, ends = screws.map(() => [-Infinity, Infinity])) {
  const isPose = goal.length > 3, point = isPose ? goal.slice(12, 15) : goal;
  const gapAt = (q) => {
    const D = displacements(screws, q), T = product(D.at(-1), M), p = T.slice(12, 15);
    const axes = isPose ? [0, 4, 8].map((k) => crossed(T.slice(k, k + 3), goal.slice(k, k + 3))) : [[], [], []];
    const gap = [...point.map((x, i) => x - p[i]), ...axes[0].map((x, i) => (x + axes[1][i] + axes[2][i]) / 2)]; // and the turn left
    return { q, D, p, gap, far: Math.hypot(...gap) };
  };
  const free = ends.map(Boolean); // a joint that has come to its end does not help any more
  let here = gapAt(theta), damping = 1e-3;
  for (let step = 0; step < 25 && here.far > 1e-6 && damping < 1e3; step += 1) {
    const column = (T, S) => [...velocityOf(T, S, here.p), ...(isPose ? turned(T, S.slice(0, 3)) : [])];
    const columns = screws.map((S, k) => (free[k] ? column(k ? here.D[k - 1] : null, S) : null));
    const A = here.gap.map((_, i) => here.gap.map((_, j) => columns.reduce((sum, c) => sum + (c ? c[i] * c[j] : 0), i === j ? damping : 0)));
    const y = solve(A, here.gap);
    const change = columns.map((c) => (c ? c.reduce((sum, x, i) => sum + x * y[i], 0) : 0));
    const calm = Math.min(1, 0.2 / Math.max(...change.map(Math.abs), 1e-12)); // no joint leaps
    const q = here.q.map((value, k) => (columns[k] ? Math.min(ends[k][1], Math.max(ends[k][0], value + calm * change[k])) : value));
    const there = gapAt(q);
    if (there.far < here.far) { // only what brings the tool nearer counts
      here = there;
      damping = Math.max(1e-6, damping / 4);
      q.forEach((value, k) => { if (free[k] && (value === ends[k][0] || value === ends[k][1])) free[k] = false; });
    } else damping *= 8;
  }
  return here;
}

// A direction as T turns it; null turns nothing.
const turned = (T, [x, y, z]) => (T ? [0, 1, 2].map((i) => T[i] * x + T[4 + i] * y + T[8 + i] * z) : [x, y, z]);
const crossed = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** How fast a point p goes when a joint moves, whose screw S the joints before carried by T (null: by nothing). */
export function velocityOf(T, S, p) {
  const from = T ? p.map((x, i) => x - T[12 + i]) : p, v = turned(T, S.slice(3));
  return crossed(turned(T, S.slice(0, 3)), from).map((x, i) => x + v[i]);
}

/** Where the arrows of J's columns stand, as arrow_at in Python. @param {{screws: number[][], M: number[]}} arm @param {number[][]} D displacements */
export function arrowsOf({ screws, M }, D) {
  const tool = product(D.at(-1), M).slice(12, 15);
  return screws.map((S, k) => {
    const v = velocityOf(k ? D[k - 1] : null, S, tool), speed = Math.hypot(...v), long = Math.max(speed, 1e-6);
    const z = speed > 1e-6 ? v.map((x) => x / speed) : [0, 0, 1], y = crossed(z, [0.48, 0.6, 0.64]);
    const wide = Math.sqrt(long) / Math.hypot(...y), scaled = (axis, by) => [...axis.map((x) => x * by), 0];
    return [...scaled(crossed(y, z), wide), ...scaled(y, wide), ...scaled(z, long), ...tool, 1];
  });
}

// x of A x = b, where A is symmetric and positive definite: no pivot has to be looked for.
function solve(A, b) {
  const rows = A.map((row, i) => [...row, b[i]]);
  rows.forEach((row, i) => rows.forEach((other) => {
    const part = other[i] / row[i];
    if (other !== row) row.forEach((x, j) => (other[j] -= part * x));
  }));
  return rows.map((row, i) => row[b.length] / row[i]);
}
