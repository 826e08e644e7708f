# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of walk_importance for colcon and pip."""

from setuptools import find_packages, setup

NAME = "walk_importance"

setup(
    name=NAME,
    version="0.1.0",
    description="Which places of a building are worth a look: importance map and keypoints.",
    author="The walkthrough planner's authors",
    license="Apache-2.0",
    packages=find_packages(),
    package_data={NAME: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    python_requires=">=3.11",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    entry_points={
        "console_scripts": [
            "importance = walk_importance.__main__:main",
        ],
    },
)
