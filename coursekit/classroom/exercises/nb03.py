"""Exercises of notebook 03: every solution of a spherical-wrist arm, the Jacobian, Newton's method."""

from __future__ import annotations

import numpy as np

from coursekit.classroom.exercise import Block, Edge, Exercise, Hint
from coursekit.classroom.exercises import _nb03 as _say
from coursekit.classroom.exercises import _nb03_draws as _draw
from coursekit.classroom.exercises import looks

# What the student's functions may call from coursekit.kinematics.
ALLOW = (
    "lie.hat3",
    "lie.vee3",
    "lie.hat6",
    "lie.vee6",
    "lie.exp3",
    "lie.exp6",
    "lie.log3",
    "lie.log6",
    "lie.inverse",
    "lie.adjoint",
    "rotations.rotx",
    "rotations.roty",
    "rotations.rotz",
)

EXERCISES = [
    Exercise(
        "wrist_centre(T_sd, tool)",
        look=looks.point,
        points=1,
        draw=_draw.target,
        shape=(3,),
        unit="m",
        samples=3,
        edges=(
            Edge("for the report's target", _draw.the_report),
            Edge("for a tool frame that is not turned", _draw.target_not_turned),
            Edge("for whole numbers", _draw.whole_target),
            Edge("where tool is negative", _draw.behind_the_flange),
            Edge("where tool is 0", lambda rng: (_draw.target(rng)[0], 0.0)),
        ),
        usual="for a tool frame that is turned",
        blocks=(Block("x of P", 0), Block("y of P", 1), Block("z of P", 2)),
        residual=_say.seen_from_the_tool,
        hints=(
            Hint("inverse", "the inverse of T_sd maps space to tool; P is known in the tool frame"),
            Hint("added", "from the tool back to the wrist: the step goes against x of the tool"),
            Hint("along_z", "this tool lies along the x axis of its own frame, not along z"),
            Hint("space_x", "you stepped along x of the space frame; the tool turns with the target"),
            Hint("row", "you took the first row of R; the x axis of the tool is a column"),
            Hint(
                "direction",
                "this is the step back alone, turned: it starts at the origin of the tool frame (the fourth"
                " number of a point is 1)",
            ),
        ),
    ),
    Exercise(
        "subproblem1(k, x, y)",
        look=looks.turned,
        points=2,
        draw=lambda rng: _draw.turn_by(rng, 0.25, 1.3),
        shape=(),
        compare="angle",
        unit="rad",
        samples=3,
        edges=(
            Edge("for a turn of more than 90 degrees", lambda rng: _draw.turn_by(rng, 1.8, 2.9), 2),
            Edge("for a negative turn", lambda rng: _draw.turn_by(rng, -1.3, -0.25), 2),
            Edge(
                "for a negative turn of more than 90 degrees", lambda rng: _draw.turn_by(rng, -2.9, -1.8), 2
            ),
            Edge(
                "where x and y are at right angles to k", lambda rng: _draw.turn_by(rng, 0.25, 1.3, True), 2
            ),
            Edge("for half a turn", _draw.half_turn),
            Edge("for a tiny turn", lambda rng: _draw.turn_by(rng, -3e-5, -2e-5)),
            Edge("for nearly half a turn", lambda rng: _draw.turn_by(rng, -3.1415, -3.141)),
            Edge("for whole numbers", _draw.whole_turn_numbers),
        ),
        usual="for turns between 0 and 90 degrees",
        residual=_say.turned_too_far,
        laws=(("turning x by your angle about k must give y", _draw.turns_x_to_y),),
        hints=(
            Hint("swapped", "numpy's arctan2 takes the sine first, then the cosine"),
            Hint("not_removed", "only the parts of x and y across k turn: take the part along k away first"),
            Hint("whole_lengths", "divide by the lengths of the parts across k, not by those of x and y"),
            Hint("sign", "it turns the other way: the sine is measured about k, from x to y"),
            Hint(
                "arccos", "an arccos, or a norm as the sine, is never negative: the sense of the turn is lost"
            ),
            Hint("arctan", "arctan of a quotient knows two quadrants only: use arctan2"),
            Hint(
                "arcsin", "an arcsin never leaves the right half of the circle: arctan2 takes the cosine, too"
            ),
        ),
    ),
    Exercise(
        "elbow_solutions(r, z, lengths)",
        look=looks.elbows,
        points=3,
        draw=_draw.triangle,
        shape=(2, 2),
        compare="set",
        unit="rad",
        samples=4,
        edges=(
            Edge("for the report's target", _draw.the_report_in_plane),
            Edge("where P is behind the shoulder", lambda rng: _draw.triangle(rng, out=-1), 2),
            Edge("where P is below the shoulder", lambda rng: _draw.triangle(rng, up=-1), 2),
            Edge("where P is near the shoulder and the arm folded", _draw.folded, 2),
            Edge("where P is straight behind the shoulder", lambda rng: _draw.level_or_upright(rng, -1, 0)),
            Edge("where P is straight above the shoulder", lambda rng: _draw.level_or_upright(rng, 0, 1)),
            Edge("where a1 is 0", lambda rng: _draw.triangle_without(rng, 0)),
            Edge("where a3 is 0", lambda rng: _draw.triangle_without(rng, 3)),
            Edge("where a3 is negative", lambda rng: _draw.triangle_without(rng, 3, -1)),
            Edge("for whole numbers", lambda rng: (5, 7, [1, 2, 5, 3, 4])),
        ),
        usual="where P is in front of the shoulder and above it",
        blocks=(Block("theta_2", np.s_[:, 0]), Block("theta_3", np.s_[:, 1])),
        residual=_say.misses_the_wrist_centre,
        laws=(("each row, put back into the arm, must put the wrist centre at (r, z)", _draw.reaches),),
        hints=(
            Hint(
                "height",
                "the angle of the line shoulder to P starts at the shoulder: P is d1 lower from there",
            ),
            Hint("from_floor", "the angle phi is seen from the shoulder: atan2(z - d1, r - a1)"),
            Hint("no_psi", "the forearm is not straight: a3 turns theta3 by a constant angle"),
            Hint("plus_square", "the square of the forearm has the wrong sign in the law of cosines"),
            Hint(
                "one_only", "that is one of the two solutions: the elbow can lie on either side of the line"
            ),
            Hint("no_arccos", "the law of cosines gives cosines: alpha and beta are their arccos"),
            Hint("mixed", "theta2 of one solution stands beside theta3 of the other"),
            Hint("beta", "theta3 turns by pi - beta: beta is an angle of the triangle, pi if stretched"),
        ),
    ),
    Exercise(
        "wrist_angles(R)",
        look=looks.from_wrist,
        points=2,
        draw=lambda rng: _draw.bent(rng, (0.3, 1.3)),
        shape=(2, 3),
        compare="set",
        unit="rad",
        edges=(
            Edge("where R[0, 0] is negative", lambda rng: _draw.bent(rng, (1.8, 2.8)), 2),
            Edge("where R[2, 0] is positive", lambda rng: _draw.bent(rng, (0.3, 1.3), out4=-1), 2),
            Edge("where R[0, 2] is negative", lambda rng: _draw.bent(rng, (0.3, 1.3), out6=-1), 2),
            Edge("where the wrist is nearly straight", lambda rng: _draw.bent(rng, (5e-4, 9e-4))),
            Edge("for whole numbers", _draw.whole_wrist(0, 1, 1)),
            Edge("for whole numbers", _draw.whole_wrist(2, 1, 2)),
        ),
        usual="where R[0, 0] > 0, R[2, 0] < 0 and R[0, 2] > 0",
        blocks=(
            Block("theta_4", np.s_[:, 0]),
            Block("theta_5", np.s_[:, 1]),
            Block("theta_6", np.s_[:, 2]),
        ),
        residual=_say.misses_the_rotation,
        laws=(("each row, put back into Rx(-t4) Ry(t5) Rx(-t6), must give R", _draw.gives_R),),
        hints=(
            Hint("sqrt", "R11 is a cosine; its sine is the root of 1 - R11 squared, not of 1 - R11"),
            Hint("xyz", "you solved for x-y-z angles; axes 4 and 6 are both along x, so it is x-y-x"),
            Hint("signs", "axes 4 and 6 point to -x: both angles change their sign"),
            Hint(
                "no_minus", "the first column is divided by -sin(theta5): the minus belongs to both entries"
            ),
            Hint("arctan", "arctan of a quotient loses which of the two was negative: arctan2 takes both"),
            Hint(
                "arcsin", "an arcsin never leaves the right half of the circle: arctan2 takes the cosine, too"
            ),
            Hint("one_only", "that is one of the two solutions: the wrist can bend to the other side"),
            Hint("half_flip", "with theta5 negative, joints 4 and 6 have to turn by half a turn as well"),
            Hint("degrees", "half a turn is pi, not 180: the angles are in radians"),
        ),
    ),
    Exercise(
        "all_solutions(T_sd, lengths, tool)",
        look=looks.arm,
        points=4,
        draw=_draw.reachable,
        shape=(8, 6),
        compare="set",
        unit="rad",
        samples=2,
        n=14,
        edges=(
            Edge("for the report's target", _draw.the_report_in_reach),
            Edge("where P has a negative x", lambda rng: _draw.reachable(rng, -1), 2),
            Edge("where P has x = 0", lambda rng: _draw.whole_reachable(rng, (0, -5))),
            Edge("where P has y = 0 and a negative x", lambda rng: _draw.whole_reachable(rng, (-5, 0))),
            Edge("for whole numbers", _draw.whole_reachable),
        ),
        usual="where P has a positive x",
        blocks=tuple(Block(f"theta_{i + 1}", np.s_[:, i]) for i in range(6)),
        residual=_say.joints_that_miss,
        laws=(("each row, put through the arm, must give T_sd back", _draw.gives_T),),
        hints=(
            Hint(
                "front_only",
                "these reach to the front; joint 1 can turn round, the arm then bends backwards over axis 1"
                " (if you have that, does `return` stand inside the loop?)",
            ),
            Hint("axis_1", "axis 1 points down: a positive theta1 turns from y to x"),
            Hint(
                "axis_1_throughout",
                "axis 1 points down: theta1 and the angle of P in the room have opposite signs",
            ),
            Hint("turned_up", "axis 1 points down: the turn of joints 1 to 3 begins with Rz(-theta1)"),
            Hint("not_undone", "R_123 has to be undone: its transpose stands before R_sd"),
            Hint("same_r", "bent backwards over axis 1 the arm reaches to -r, not to r"),
            Hint("r_exchanged", "to the front belongs theta1 with r; -r goes with theta1 + pi"),
            Hint(
                "theta3_taken_off", "joints 2 and 3 turn about the same y: the hand turns by theta2 + theta3"
            ),
            Hint(
                "no_flip", "joints 4 to 6 have two solutions for each of the four arms: four rows are missing"
            ),
            Hint("duplicates", "some rows stand twice, and others are missing"),
            Hint("R_reversed", "what is left for the wrist is R_123 transposed times R_sd, in this order"),
        ),
    ),
    Exercise(
        "jacobian_column(kind, w, q, T)",
        look=_say.seen_in_space,
        points=2,
        draw=_draw.column,
        shape=(6,),
        unit="1, m",
        samples=3,
        edges=(
            Edge("for a slide", lambda rng: _draw.column(rng, "prismatic"), 2),
            Edge("for a tool frame that is not turned", lambda rng: _draw.column(rng, R=np.eye(3))),
            Edge("for an axis through the tool point", _draw.through_the_tool),
            Edge("for a w of whole numbers", _draw.along_an_axis),
            Edge("for whole numbers", _draw.whole_column),
        ),
        usual="for a hinge",
        blocks=(
            Block("the upper half (omega)", np.s_[:3]),
            Block("the lower half (v)", np.s_[3:]),
        ),
        residual=_say.carries_the_tool_otherwise,
        hints=(
            Hint(
                "not_turned",
                "these are the components along the axes of the room: turn both into the tool frame",
            ),
            Hint("turned_back", "R of T maps from the tool to the room; you need the other way"),
            Hint(
                "reversed", "v = w x (p - q), from the axis to the tool point: your v has the opposite sign"
            ),
            Hint(
                "at_the_origin", "-w x q is the velocity of the room's origin; here the tool point p counts"
            ),
            Hint("slide_as_hinge", "a slide turns nothing: its column is (0; w)"),
            Hint(
                "slide_turns",
                "a slide moves the tool along w, and does not turn it: its halves are exchanged",
            ),
            Hint("v_first", "(omega; v): you exchanged the two halves"),
        ),
    ),
    Exercise(
        "newton_step(J_b, T_sb, T_sd)",
        points=2,
        draw=_draw.search,
        shape=(None,),
        unit="rad",
        samples=3,
        edges=(
            Edge("for seven joints", lambda rng: _draw.search(rng, 7), 2),
            Edge("for two joints", lambda rng: _draw.search(rng, 2)),
            Edge("where J_b is singular", _draw.singular_search),
            Edge("where J_b is nearly singular", _draw.search_near_singular),
            Edge("where the target is turned far", lambda rng: _draw.search_far_or_near(rng, 2.3, 0.2)),
            Edge("where the target is near", lambda rng: _draw.search_far_or_near(rng, 3e-4, 2e-4)),
            Edge("where the target is only shifted", lambda rng: _draw.search(rng, turned=False)),
            Edge("where the target is only turned", lambda rng: _draw.search(rng, shifted=False)),
            Edge("for whole numbers", _draw.whole_search),
        ),
        usual="for six joints",
        residual=_say.moves_the_tool_otherwise,
        hints=(
            Hint("space", "J_b wants the error seen from the tool; yours is seen from the space frame"),
            Hint("difference", "the difference of two matrices is not a twist: take the logarithm"),
            Hint("transpose", "that is J_b transposed; Newton's step needs the pseudo-inverse"),
            Hint("backwards", "the step leads away from the target: the error goes from here to there"),
            Hint("positions", "the lower half of e is no difference of positions: take log6 of T_sb^-1 T_sd"),
            Hint(
                "positions_in_tool",
                "v is the way to the target only where the tool does not turn: take log6 of T_sb^-1 T_sd",
            ),
            Hint("two_logs", "logarithms of poses do not subtract: multiply the poses first, then take one"),
        ),
    ),
    Exercise(
        "subproblem3(k, x, y, distance)",
        look=looks.at_a_distance,
        points=2,
        draw=_draw.distance,
        shape=(2,),
        compare="set",
        unit="rad",
        samples=3,
        edges=(
            Edge("where x and y lie in the plane across k", lambda rng: _draw.distance(rng, True), 2),
            Edge("where y lies far along k", _draw.far_apart),
            Edge("where x and y lie on opposite sides of the axis", _draw.opposite),
            Edge("for whole numbers", _draw.whole_distance),
        ),
        usual="where x and y differ in height along k",
        residual=_say.at_another_distance,
        laws=(
            (
                "turning x by each of your angles must bring it to the distance from y",
                _draw.keeps_the_distance,
            ),
        ),
        hints=(
            Hint(
                "not_removed",
                "in the plane across k lie only the parts of x and y across k: shorten all three sides",
            ),
            Hint("no_height", "x and y differ in height along k: that part of the distance no turn changes"),
            Hint(
                "around_zero", "the two angles lie around the one that brings x in line with y, not around 0"
            ),
            Hint("from_y", "you turn y to x: x turns about k, so the middle angle leads from x to y"),
            Hint("one_only", "that is one of two: x can come to the distance on either side of y"),
        ),
    ),
    Exercise(
        "subproblem2(k1, k2, x, y)",
        look=looks.turned_twice,
        points=3,
        draw=_draw.two_turns,
        shape=(2, 2),
        compare="set",
        unit="rad",
        samples=3,
        edges=(
            Edge("for axes at right angles", lambda rng: _draw.two_turns(rng, upright=True), 2),
            Edge("where x lies on the first axis", lambda rng: _draw.two_turns(rng, along=True)),
            Edge("for whole numbers", _draw.whole_two_turns),
        ),
        usual="for axes that are not at right angles",
        blocks=(Block("the angle t1", np.s_[:, 0]), Block("the angle t2", np.s_[:, 1])),
        residual=_say.two_turns_that_miss,
        laws=(("turning x by t2 about k2 and then by t1 about k1 must give y", _draw.turns_both),),
        hints=(
            Hint(
                "right_angles",
                "right for axes at right angles only: otherwise k1 . z holds a part of b as well",
            ),
            Hint("exchanged", "each row is (t1, t2): you have t2 first"),
            Hint("backwards", "both turns go backwards: k2 carries x to z, k1 carries z to y"),
            Hint("heights", "z has the height of y along k1 and that of x along k2; you exchanged them"),
            Hint(
                "heights_nan",
                "k1 . z is k1 . y, and k2 . z is k2 . x: you exchanged them, and the circles miss",
            ),
            Hint(
                "without_c",
                "right for axes at right angles only: k1 and k2 have the product c = k1 . k2 otherwise",
            ),
            Hint("mixed", "t1 of one solution stands beside t2 of the other"),
            Hint("one_only", "that is one of two: the circles meet in two points"),
        ),
    ),
]
