"""Install a lock into a virtual environment of its own: `python3 locks/install.py FOLDER LOCK [--editable]`.

The Makefile runs this with the Python that the user has, so the file must parse in an old one too, to say so.
pip keeps the user's own settings (index, mirror, certificates). Its output is shown only when it fails: one
line for what people meet (no network, no disk space, no venv module), pip's own errors for the rest, and the
whole output in FOLDER/install.log.
"""

import os
import re
import subprocess
import sys

OLDEST = (3, 11)
# The lock holds every package that is needed (locks/closed.py), so nothing is resolved here, and a newer
# release in the index changes nothing.
LOCKED = ["--no-deps", "--require-hashes"]

# What a failed command printed, and what to do about it; the first match is told.
REMEDIES = [
    (r"No space left on device|Errno 28|Disk quota exceeded",
     "no space left for {folder} (it takes 1.3 GB) or for temporary files; free some, or set TMPDIR"),
    (r"CERTIFICATE_VERIFY_FAILED|certificate verify failed",
     "the package index's certificate is not trusted; behind a proxy, set PIP_CERT to the proxy's"),
    (r"NewConnectionError|ConnectTimeout|ReadTimeout|ProxyError|NameResolutionError|connection broken by"
     r"|Max retries exceeded|Network is unreachable|Connection refused|Read timed out",
     "the package index cannot be reached; check the network, or set PIP_INDEX_URL to a mirror"),
    (r"DO NOT MATCH THE HASHES",
     "the package index sent other files than the lock names; set PIP_INDEX_URL to another index"),
    (r"No matching distribution found for (?P<what>[^\s;]+)",
     "the package index has no {what} for this Python and machine; try another Python "
     "(make PYTHON=python3.12 ...) or index (PIP_INDEX_URL)"),
    (r"Permission denied|Errno 13|Read-only file system",
     "no permission to write {folder} or the temporary folder; make them writable, or set TMPDIR"),
]  # fmt: skip


class InstallationError(Exception):
    """The installation failed; the text is what the user reads."""


def check_python():
    """Fail if this Python is too old or cannot make virtual environments."""
    here = "%d.%d" % sys.version_info[:2]
    if sys.version_info < OLDEST:
        raise InstallationError(
            "Python %d.%d or later is needed, %s is %s; name another: make PYTHON=python3.12 ..."
            % (OLDEST + (sys.executable, here))
        )
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401

        missing = None
    except ImportError as error:
        missing = error
    if missing:
        raise InstallationError(
            "Python %s has no venv module (%s); on Debian or Ubuntu: apt install python%s-venv"
            % (here, missing, here)
        )


def explain(output, folder):
    """Give the line for a failed command's output, or None if the failure is not one of REMEDIES."""
    for pattern, remedy in REMEDIES:
        found = re.search(pattern, output)
        if found:
            return remedy.format(folder=folder, what=found.groupdict().get("what"))
    return None


def run(folder, words):
    """Run a command in silence. InstallationError: it failed, with what to do or with its last errors."""
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode == 0:
        return
    output = done.stdout.decode("utf-8", "replace")
    log = os.path.join(folder, "install.log")
    try:
        with open(log, "w", encoding="utf-8") as file:
            file.write("%s\n%s" % (" ".join(words), output))
    except OSError:
        log = None
    said = explain(output, folder)
    if said is None:
        lines = [line for line in output.splitlines() if line.strip() and not line.startswith("WARNING")]
        errors = [line for line in lines if line.lower().startswith("error")] or lines
        said = "\n".join(errors[-5:]) or "%s ended with status %d" % (words[0], done.returncode)
    raise InstallationError(said + ("; the whole output: %s" % log if log else ""))


def environment_of(folder):
    """Make the virtual environment unless this Python's is there already; give its interpreter."""
    python = os.path.join(folder, "bin", "python")
    about = "import pip, sys; sys.exit(sys.version_info[:2] != (%d, %d))" % sys.version_info[:2]
    usable = os.path.exists(python) and not subprocess.call(
        [python, "-c", about], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    if not usable:
        # In two steps: venv alone would keep ensurepip's message to itself.
        run(folder, [sys.executable, "-m", "venv", "--clear", "--without-pip", folder])
        run(folder, [python, "-Im", "ensurepip", "--upgrade", "--default-pip"])
    return python


def install(folder, lock, editable):
    """Make the environment in a folder, install the lock, and the project itself if it is to be editable."""
    check_python()
    python = environment_of(folder)
    pip = [python, "-m", "pip", "--disable-pip-version-check", "--quiet", "--no-input", "install"]
    run(folder, pip + LOCKED + ["-r", lock])
    if editable:
        run(folder, pip + ["--no-deps", "--no-build-isolation", "-e", "."])


def main(words):
    """Install as the command line asks; give the exit status."""
    try:
        install(words[0], words[1], "--editable" in words[2:])
    except InstallationError as failure:
        sys.stderr.write("%s\n" % failure)
        return 1
    except OSError as error:
        sys.stderr.write("%s\n" % (explain(str(error), words[0]) or error))
        return 1
    except KeyboardInterrupt:
        sys.stderr.write("interrupted; the next make goes on\n")
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
