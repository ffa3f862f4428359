// The light of a small bright room, as rough paint reflects it: what makes painted metal look like it. In the layout of
// three's prefiltered cubes (CubeUV), but only the faces of 16 pixels, which is all that rough paint ever reads. Three's own
// generator also blurs sharp ones: ten seconds without a GPU, for nothing.
const SMOOTHEST = 0.25; // roughness: below, sharper faces would be read
const BLURS = [0.069, 0.128, 0.217, 0.351, 0.447, 0.527, 0.583]; // radians, of the seven levels for more and more roughness
const WALLS = [0.553, 0.573, 0.6];
/** @type {[number, number[], number[], number[]][]} */
const LAMPS = [ // brightness, centre, and two half sides
  [9, [0, 2.9, 0], [2.5, 0, 0], [0, 0, 2.5]],
  [5, [-4.9, 0.8, 1], [0, 1.3, 0], [0, 0, 2]],
  [3.5, [3, 1, 4.9], [2, 0, 0], [0, 1.2, 0]],
  [0.25, [0, -2.95, 0], [4.5, 0, 0], [0, 0, 4.5]], // a floor that is darker than the walls
];
const CUBE = [ // from a point (u, v) of a face to its direction
  (u, v) => [1, v, u], (u, v) => [-u, 1, -v], (u, v) => [-u, v, 1], (u, v) => [-1, v, -u], (u, v) => [-u, -1, v], (u, v) => [u, v, -1],
];

async function studioLight(THREE) {
  const side = 768, face = 16, pixels = new Uint8Array(4 * side * side);
  for (const [level, blur] of BLURS.entries()) {
    await pause(0); // each level is a task of its own
    const around = 2 * Math.PI * blur ** 2 * (1 - Math.exp(-2 / blur ** 2)); // what a blurred point adds up to
    const points = LAMPS.flatMap(([light, centre, a, b]) => { // each lamp in pieces: direction, part of the view, brightness
      const [n, m] = [a, b].map((half) => Math.ceil(Math.hypot(...half) / Math.max(light > 1 ? 0.2 : 0.6, 1.2 * blur)));
      return Array.from({ length: n * m }, (_, i) => {
        const [s, t] = [(2 * (i % n) + 1) / n - 1, (2 * Math.floor(i / n) + 1) / m - 1];
        const p = centre.map((x, k) => x + s * a[k] + t * b[k]), far = Math.hypot(...p), across = crossed(a, b);
        const tilt = Math.abs(across.reduce((sum, x, k) => sum + x * p[k], 0)) / far;
        return [...p.map((x) => x / far), (4 * tilt) / (n * m * far ** 2 * around), light];
      }).flat();
    });
    for (let i = 0; i < 6 * face * face; i += 1) {
      const [x, y, k] = [i % face, Math.floor(i / face) % face, Math.floor(i / face ** 2)];
      const way = CUBE[k]((2 * x) / (face - 1) - 1, (2 * y) / (face - 1) - 1), long = Math.hypot(...way);
      let lit = 0, covered = 0;
      for (let n = 0; n < points.length; n += 5) {
        const near = ((way[0] * points[n] + way[1] * points[n + 1] + way[2] * points[n + 2]) / long - 1) / blur ** 2;
        if (near < -9) continue;
        covered += points[n + 3] * Math.exp(near);
        lit += points[n + 4] * points[n + 3] * Math.exp(near);
      }
      const colour = WALLS.map((wall) => wall * (1 - covered) + lit), power = Math.ceil(Math.log2(Math.max(...colour)));
      const at = side * (2 * 256 + 2 * face * level + face * Math.floor(k / 3) + y) + 3 * (256 - 2 * face) + face * (k % 3) + x;
      pixels.set([...colour.map((c) => (255 * c) / 2 ** power), power + 128], 4 * at); // red, green, blue and a power of two for all
    }
  }
  return Object.assign(new THREE.DataTexture(pixels, side, side), { mapping: THREE.CubeUVReflectionMapping, encoding: THREE.RGBEEncoding, needsUpdate: true });
}
