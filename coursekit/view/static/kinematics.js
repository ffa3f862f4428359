// Kinematics in the page: where the links of an arm stand, from its screws. The same numbers as Robot.displacements in
// Python; so an arm follows its sliders in the next frame, also where no kernel runs.

/** e^[S]q of a screw S = (w; v), |w| = 1 or w = 0: 16 numbers, by columns as in three.js. @param {number[]} S @param {number} q radians, or metres where w = 0 */
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

/** What Scene.text says in Python, for pages where no kernel does. @param {{name: string, screws: number[][], M: number[]}} arm @param {number[]} theta */
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
const turned = (T, a) => (T ? [0, 1, 2].map((i) => T[i] * a[0] + T[4 + i] * a[1] + T[8 + i] * a[2]) : a);
const crossed = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** How fast a point p goes when a joint moves, whose screw S the joints before carried by T (null: by nothing). */
export function velocityOf(T, S, p) {
  const from = T ? p.map((x, i) => x - T[12 + i]) : p, v = turned(T, S.slice(3));
  return crossed(turned(T, S.slice(0, 3)), from).map((x, i) => x + v[i]);
}

/**
 * What shows a Jacobian at the tool, as arrow_at and marks.ellipsoid in Python place it: path -> 16 numbers. D: displacements
 * @param {{screws: number[][], M: number[], shapes: Object<string, [string, number]>}} arm path -> half of J, scale of its ellipsoid or 0
 */
export function shapesOf({ screws, M, shapes }, D) {
  const tool = product(D.at(-1), M).slice(12, 15), before = (k) => (k ? D[k - 1] : null);
  const J = { linear: (S, k) => velocityOf(before(k), S, tool), angular: (S, k) => turned(before(k), S.slice(0, 3)) }; // a column of each half
  return Object.assign({}, ...Object.entries(shapes).map(([path, [half, scale]]) => (scale ? ellipsoid : arrows)(path, screws.map(J[half]), tool, scale)));
}

const times = (v, by) => v.map((x) => x * by);
const arrows = (path, columns, tool) => Object.fromEntries(columns.map((v, k) => [`${path}/${k + 1}`, arrow(v, tool)]));
const matrix = (x, y, z, p) => [...x, 0, ...y, 0, ...z, 0, ...p, 1];
function arrow(v, tool) {
  const speed = Math.hypot(...v), long = Math.max(speed, 1e-6);
  const z = speed > 1e-6 ? times(v, 1 / speed) : [0, 0, 1], y = crossed(z, [0.48, 0.6, 0.64]), wide = Math.sqrt(long) / Math.hypot(...y);
  return matrix(times(crossed(y, z), wide), times(y, wide), times(z, long), tool);
}
function ellipsoid(path, columns, tool, scale) {
  const U = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], J = U.map((_, i) => columns.map((column) => column[i]));
  const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0), mixed = (a, x, b, y) => a.map((one, i) => x * one + y * b[i]);
  for (let turn = 0; turn < 24; turn += 1) { // until the rows of U J stand upright on each other (Jacobi): they are the half axes
    const [i, j] = [[0, 1], [0, 2], [1, 2]][turn % 3], angle = Math.atan2(2 * dot(J[i], J[j]), dot(J[i], J[i]) - dot(J[j], J[j])) / 2;
    for (const A of [U, J]) [A[i], A[j]] = [mixed(A[i], Math.cos(angle), A[j], Math.sin(angle)), mixed(A[j], Math.cos(angle), A[i], -Math.sin(angle))];
  }
  const long = J.map((row) => scale * Math.hypot(...row)), half = U.map((axis, k) => times(axis, Math.max(long[k], 1e-3 * Math.max(...long, 1e-9))));
  const rod = (k) => [`${path}/axis${k + 1}`, matrix(U[(k + 1) % 3], U[(k + 2) % 3], half[k], tool)];
  return { [`${path}/body`]: matrix(half[0], half[1], half[2], tool), ...Object.fromEntries([0, 1, 2].map(rod)) };
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
