# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Plans every building of a folder and writes a table of what came of it.

./walk python examples/batch.py FOLDER [OUT]
"""

import csv
import sys
import time
from pathlib import Path

from walk_building import WalkError
from walk_building.loaders import LOADERS
from walk_plan.pipeline import plan_walkthrough

if len(sys.argv) < 2:
    sys.exit("which folder? ./walk python examples/batch.py FOLDER [OUT]")
folder, out = Path(sys.argv[1]), Path(sys.argv[2] if len(sys.argv) > 2 else "out/batch")
files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in LOADERS)
if not files:
    sys.exit(f"no building in {folder}; what can be read: {' '.join(sorted(LOADERS))}")

rows = []
for file in files:
    began = time.perf_counter()
    row: dict[str, object] = {"building": str(file.relative_to(folder))}
    try:
        walk = plan_walkthrough(file, out / file.stem)
    except WalkError as error:
        row["problem"] = str(error)
    else:
        ours = walk.qualities[0]
        row |= {
            "rooms": len(walk.building.rooms),
            "entered": len(ours.rooms),
            "keypoints": len(walk.tour.order),
            "length_m": round(walk.path.length_m, 1),
            "duration_s": round(walk.trajectory.duration_s, 1),
            "colliding": len(walk.path.colliding),
        }
    row["seconds"] = round(time.perf_counter() - began, 1)
    rows.append(row)
    print(", ".join(f"{key} {value}" for key, value in row.items()), flush=True)

names = ["building", "rooms", "entered", "keypoints", "length_m", "duration_s", "colliding", "seconds", "problem"]
out.mkdir(parents=True, exist_ok=True)
with (out / "table.csv").open("w", newline="", encoding="utf-8") as table:
    writer = csv.DictWriter(table, names)
    writer.writeheader()
    writer.writerows(rows)
print(f"{out / 'table.csv'} is written")
