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

    Files already in `out` are replaced only then, and only those of the same name.
    """
    try:
        if out.exists() and not out.is_dir():
            raise UserError(f"{out}: expected a folder for the output, but it is a file")
        out.absolute().parent.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=f".{out.name}-", dir=out.absolute().parent))
        try:
            yield scratch
            out.mkdir(exist_ok=True)
            for file in sorted(scratch.iterdir()):
                file.replace(out / file.name)
        finally:
            shutil.rmtree(scratch, ignore_errors=True)
    except OSError as error:
        raise UserError(
            f"{error.filename or out}: {(error.strerror or str(error)).lower()}"
        ) from None
