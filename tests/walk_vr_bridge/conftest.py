# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
import asyncio

import pytest


@pytest.fixture
def run():
    """Runs a coroutine to its end, within a minute."""

    def runner(coroutine):
        async def limited():
            return await asyncio.wait_for(coroutine, 60)

        return asyncio.run(limited())

    return runner
