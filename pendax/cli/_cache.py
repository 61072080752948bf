"""Compiled programs, kept on disk from one run to the next.

By request: a cache that nobody asked for would grow in every home, where another machine that
shares it may find programs for a processor that it does not have.
"""

import os
import sys
import tempfile
from pathlib import Path

HELP = "keep compiled programs for the next run, in $JAX_COMPILATION_CACHE_DIR or the user's cache"

# JAX by itself keeps what took a second to compile: most programs here take less, all of them
# together a few seconds.
_ALL = {
    "jax_persistent_cache_min_compile_time_secs": 0,
    "jax_persistent_cache_min_entry_size_bytes": -1,
}


def keep_programs() -> None:
    """From now on, where JAX is told to or else by the user's custom; if it can't be, says so."""
    import jax

    try:
        folder = os.environ.get("JAX_COMPILATION_CACHE_DIR") or str(_folder())
        if "://" not in folder:  # else a bucket, which JAX knows how to open
            Path(folder).mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
    except (OSError, RuntimeError) as error:  # RuntimeError: no home
        print(f"pendax: no cache: {error}", file=sys.stderr)
        folder = None
    jax.config.update("jax_compilation_cache_dir", folder)
    for name, value in _ALL.items():
        if name.upper() not in os.environ:
            jax.config.update(name, value)


def _folder() -> Path:
    """Where the platform keeps what may be deleted at any time."""
    home = Path.home()
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or home / "AppData/Local"
    elif sys.platform == "darwin":
        base = home / "Library/Caches"
    else:
        base = os.environ.get("XDG_CACHE_HOME") or home / ".cache"
    return Path(base) / "pendax"
