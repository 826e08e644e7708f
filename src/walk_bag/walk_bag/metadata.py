# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`metadata.yaml` of a rosbag2 directory."""

from __future__ import annotations

from typing import Any

import yaml

from walk_bag.mcap_file import Counted, McapFile
from walk_bag.topics import qos_to_yaml

VERSION = 8
"""Of the format: what the readers of Humble's time understand, too."""


def metadata_yaml(file: McapFile) -> str:
    """Returns what rosbag2 wants to know of a bag of one MCAP file."""
    about: dict[str, Any] = {
        "version": VERSION,
        "storage_identifier": "mcap",
        **_extent(file),
        "topics_with_message_count": [_topic(counted) for counted in file.topics.values()],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file.path.name],
        "files": [{"path": file.path.name, **_extent(file)}],
        "custom_data": None,
        "ros_distro": "jazzy",
    }
    return str(yaml.safe_dump({"rosbag2_bagfile_information": about}, sort_keys=False))


def _extent(file: McapFile) -> dict[str, Any]:
    # Made anew each time: YAML would write a reference to what it has written before.
    return {
        "duration": {"nanoseconds": file.last_ns - file.first_ns},
        "starting_time": {"nanoseconds_since_epoch": file.first_ns},
        "message_count": file.message_count,
    }


def _topic(counted: Counted) -> dict[str, Any]:
    return {
        "topic_metadata": {
            "name": counted.topic.name,
            "type": counted.topic.type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": qos_to_yaml(counted.topic),
            "type_description_hash": counted.type_hash,
        },
        "message_count": counted.messages,
    }
