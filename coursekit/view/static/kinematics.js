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
  for (let column = 0; column < 16; column += 4) {
    for (let row = 0; row < 4; row += 1) {
      C[column + row] = A[row] * B[column] + A[4 + row] * B[column + 1] + A[8 + row] * B[column + 2] + A[12 + row] * B[column + 3];
    }
  }
  return C;
}

/**
 * Where the links went from where they stand at zero: e^[S1]q1 ... e^[Sk]qk for k = 1..n, 16 numbers each.
 * @param {number[][]} screws n screws @param {number[]} theta n joint values
 */
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
  const say = (q, k) => (slides[k] ? [1000 * q, " mm"] : [(180 / Math.PI) * q, " deg"]);
  const joints = slides.includes(true)
    ? `(${theta.map((q, k) => round(say(q, k)[0]) + say(q, k)[1]).join(", ")})`
    : `(${theta.map((q, k) => round(say(q, k)[0])).join(", ")}) deg`;
  const tool = product(displacements(screws, theta).at(-1), M).slice(12, 15);
  return `${name}: joints ${joints}; tool at (${tool.map((x) => round(1000 * x)).join(", ")}) mm`;
}
