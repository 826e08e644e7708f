# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of walk_bringup for colcon and pip."""

from glob import glob

from setuptools import find_packages, setup

NAME = "walk_bringup"

setup(
    name=NAME,
    version="0.1.0",
    description="The walk command, launch files, parameters, layouts and the sample building.",
    author="The walkthrough planner's authors",
    license="Apache-2.0",
    packages=find_packages(),
    package_data={NAME: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", glob("launch/*.launch.py")),
        (f"share/{NAME}/config", glob("config/*.yaml")),
        (f"share/{NAME}/rviz", glob("rviz/*.rviz")),
        (f"share/{NAME}/foxglove", glob("foxglove/*.json")),
        (f"share/{NAME}/buildings", glob("buildings/*.ifc")),
    ],
    python_requires=">=3.11",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "walk = walk_bringup.cli.main:main",
        ],
    },
)
