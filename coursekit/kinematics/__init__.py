"""Mathematics on arrays: the room that everything else stands on, and that imports nothing but numpy.

Metres, radians, seconds. `T_ab` maps coordinates in frame b to frame a. Twists, screws and the rows of a
Jacobian are ordered (omega; v). Batch axes lead: theta (..., n) gives poses (..., 4, 4).
"""
