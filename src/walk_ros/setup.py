# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Packaging of walk_ros for colcon and pip."""

from setuptools import find_packages, setup

NAME = "walk_ros"

setup(
    name=NAME,
    version="0.1.0",
    description="The ROS code that the nodes share: conversions, QoS profiles, parameters, running a node.",
    author="The walkthrough planner's authors",
    license="Apache-2.0",
    packages=find_packages(),
    package_data={NAME: ["py.typed", "fastdds.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    python_requires=">=3.11",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
)
