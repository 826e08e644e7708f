# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`metadata.yaml` of a rosbag2 directory."""

from __future__ import annotations

from typing import Any

import yaml

from walk_bag.mcap_file import Counted, McapFile
from walk_bag.topics import qos_to_yaml

METADATA = "metadata.yaml"
"""Its name in the directory."""

VERSION = 8
"""Of the format: what the readers of Humble's time understand, too."""


def metadata_yaml(file: McapFile) -> str:
    """Returns `metadata.yaml` of a bag of one MCAP file."""
    return _yaml({"rosbag2_bagfile_information": _about(file)})


def embedded_yaml(file: McapFile) -> str:
    """Returns what rosbag2 keeps in the MCAP file itself: the same without the key above it.

    With the key rosbag2 does not open the file at all: it asks for the version first, and that is not where it looks.
    """
    return _yaml(_about(file))


def _yaml(document: dict[str, Any]) -> str:
    return str(yaml.safe_dump(document, sort_keys=False))


def _about(file: McapFile) -> dict[str, Any]:
    return {
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
