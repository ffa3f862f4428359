// What the page computes by itself when a hand moves the target, the tool or a link.

import assert from "node:assert/strict";
import { test } from "node:test";

import { displacements, movedAlong, poseOf, product, reachFor, valuesOf, velocityOf } from "../../coursekit/view/static/kinematics.js";

const near = (a, b, tolerance = 1e-12) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) < tolerance, `${a} and ${b}`));

// Three hinges of an upright arm: z at the origin, y at a height of 0.4, y 0.5 further out; the tool 0.4 behind that.
const ARM = {
  screws: [[0, 0, 1, 0, 0, 0], [0, 1, 0, -0.4, 0, 0], [0, 1, 0, -0.4, 0, 0.5]],
  M: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.9, 0, 0.4, 1],
};
const tool = (theta) => product(displacements(ARM.screws, theta).at(-1), ARM.M).slice(12, 15);
const EVERYWHERE = [[-3, 3], [-3, 3], [-3, 3]];

test("a pose from six numbers and back", () => {
  for (const values of [[0.1, -0.2, 0.3, 0.4, -0.5, 0.6], [0, 0, 0, -3, 1.5, 3], [1, 2, 3, 0, 0, 0]]) near(valuesOf(poseOf(values)), values);
});

test("yaw, pitch and roll turn about z, y and x, in this order", () => {
  near(poseOf([0, 0, 0, Math.PI / 2, 0, 0]), [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  near(poseOf([0, 0, 0, Math.PI / 2, 0, Math.PI / 2]), [0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1]);
});

test("pitched upright, the pose comes back, with a roll of 0", () => {
  const T = poseOf([0, 0, 0, 0.3, Math.PI / 2, 0.8]);
  const values = valuesOf(T);
  assert.equal(values[5], 0);
  near(poseOf(values), T, 1e-9);
});

test("a target moves along its own axes and turns about them where it stands", () => {
  const T = poseOf([0.1, 0.2, 0.3, Math.PI / 2, 0, 0]);
  near(movedAlong(T, 0, 0, 0.5).slice(12, 15), [0.1, 0.7, 0.3]);
  near(movedAlong(T, 1, 0, 0.5).slice(12, 15), [0.1, 0.2, 0.3]);
  near(valuesOf(movedAlong(T, 1, 0, 0.5)), [0.1, 0.2, 0.3, Math.PI / 2, 0, 0.5]);
});

test("the velocity of a point is what a small step of the joint makes of it", () => {
  const theta = [0.4, -0.7, 1.1], step = 1e-6;
  for (let k = 0; k < 3; k += 1) {
    const carried = displacements(ARM.screws, theta);
    const ahead = tool(theta.map((q, j) => q + (j === k ? step : 0))), behind = tool(theta.map((q, j) => q - (j === k ? step : 0)));
    const rate = ahead.map((x, i) => (x - behind[i]) / (2 * step));
    near(velocityOf(k ? carried[k - 1] : null, ARM.screws[k], tool(theta)), rate, 1e-8);
  }
});

test("the tool goes where it is pulled", () => {
  for (const goal of [[0.6, 0.3, 0.5], [0.2, -0.5, 0.7], tool([0.3, 0.2, 0.4])]) {
    near(tool(reachFor(ARM, [0.1, 0.3, 0.5], goal, EVERYWHERE).q), goal, 1e-4);
  }
});

test("out of reach it stretches, and no joint passes its end", () => {
  const { q, far } = reachFor(ARM, [0.1, 0.3, 0.5], [3, 0, 0.4], EVERYWHERE);
  assert.ok(tool(q)[0] > 0.8);
  near([far], [Math.hypot(3 - tool(q)[0], tool(q)[1], 0.4 - tool(q)[2])]);
  const held = reachFor(ARM, [0.1, 0.3, 0.5], [0.2, -0.5, 0.7], [[-0.2, 0.2], [-3, 3], [-3, 3]]).q;
  assert.ok(held[0] >= -0.2 && held[0] <= 0.2);
});

test("a joint that is not free stays", () => {
  const { q } = reachFor(ARM, [0.1, 0.3, 0.5], [0.6, 0.3, 0.5], [null, [-3, 3], [-3, 3]]);
  assert.equal(q[0], 0.1);
});
