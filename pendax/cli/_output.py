"""A folder that gets all its files or none."""

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from ._error import UserError


@contextlib.contextmanager
def output_folder(out: Path) -> Iterator[Path]:
    """A scratch folder whose files move to `out` when the block ends without an error.

    The scratch folder lies in `out`, on the same disk; if `out` is new, it is gone
    again after an error.  Files already there are replaced only at the end, and only
    those of the same name.
    """
    try:
        new = not out.exists()
        out.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=".writing-", dir=out))
        try:
            yield scratch
            files = sorted(scratch.iterdir())
            for file in files:
                if (out / file.name).is_dir():
                    raise UserError(f"{out / file.name}: expected no folder in place of a file")
            for file in files:
                file.replace(out / file.name)
        except BaseException:
            shutil.rmtree(out if new else scratch, ignore_errors=True)
            raise
        scratch.rmdir()
    except BrokenPipeError:  # of the standard output, not of a file
        raise
    except FileExistsError:
        raise UserError(f"{out}: expected a folder for the output, but it is a file") from None
    except OSError as error:
        raise UserError(f"--out {out}: {(error.strerror or str(error)).lower()}") from None
