# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of walk_vr_bridge for colcon and pip."""

from setuptools import find_packages, setup

NAME = "walk_vr_bridge"

setup(
    name=NAME,
    version="0.1.0",
    description="The headset page and the WebSocket through which headsets, Unity and scripts edit a walkthrough.",
    author="The walkthrough planner's authors",
    license="Apache-2.0",
    packages=find_packages(exclude=["web", "web.*"]),
    package_data={NAME: ["py.typed", "static/*", "static/assets/*"]},
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
            "vr_bridge = walk_vr_bridge.main:main",
        ],
    },
)
