"""What grades a class. No release holds it.

`grade` (runs no student code) copies what was handed in (`submissions`, bytes only) and sends every notebook
as a job of plain data to a `worker` of its own. The worker knows the hidden inputs and the solutions; a `box`
beside it runs the `student`'s notebook with a `locked` copy of the library (`inside/` holds what is written
for the box alone) and answers in numbers, which `reply` reads without trust. `verdict`, the ladder of the
student's own check, judges them. Records go to the `journal`, and from there to the pages of `report`.
"""
