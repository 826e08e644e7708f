# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 1: a building file becomes rooms, storeys and a surface to walk on.

./walk python examples/1_building.py [BUILDING]
"""

import sys

from walk_bringup.sample import sample_path
from walk_building import LoadOptions, WalkError, load_building

file = sys.argv[1] if len(sys.argv) > 1 else sample_path()
units_m = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0  # 0: what the file says
try:
    building = load_building(file, LoadOptions(units_m=units_m))
except WalkError as error:
    sys.exit(str(error))

low, high = building.model.vertices.min(axis=0), building.model.vertices.max(axis=0)
print(f"{building.model.source.name}: {len(building.model.faces)} triangles, {high - low} m")
for index, storey in enumerate(building.storeys):
    rooms = [room for room in building.rooms if room.storey == index]
    print(f"{storey.name or f'storey {index}'}: floor at {storey.elevation_m:.2f} m, {len(rooms)} rooms")
    for room in rooms:
        print(f"  {room.name:<24} {room.area_m2:6.1f} m²  {room.reason or 'reachable'}")

# Exact questions about the triangles, many at once: how far is it from each room's centre to the nearest wall?
eyes = [room.centre + [0.0, 0.0, building.walker.eye_height_m] for room in building.rooms]
nearest = building.geometry.closest(eyes)
for room, distance_m in zip(building.rooms, nearest.distance_m, strict=True):
    print(f"{room.name:<24} {distance_m:.2f} m from anything")
