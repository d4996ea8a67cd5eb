"""Files of uploads on the disk."""

import os
import time

from app.web.uploads import ABANDONED_SECONDS, INCOMING, remove_abandoned


def test_what_a_killed_process_left_goes_and_what_still_arrives_stays(tmp_path):
    old, new = (tmp_path / INCOMING / name for name in ("upload-old", "upload-new"))
    old.parent.mkdir()
    for path in (old, new):
        path.write_bytes(b"x")
    long_ago = time.time() - ABANDONED_SECONDS - 60
    os.utime(old, (long_ago, long_ago))
    remove_abandoned(tmp_path)
    assert not old.exists()
    assert new.exists()


def test_nothing_to_remove_is_no_error(tmp_path):
    remove_abandoned(tmp_path)
