"""What Linux says of a process: memory, descriptors and threads."""
import os
import pathlib

# Fields of /proc/PID/smaps_rollup, and their names in the samples.
MEMORY = {"Rss": "rss_mb", "Pss": "pss_mb", "Anonymous": "anonymous_mb"}


def read_memory(text: str) -> dict:
    """Reads the text of /proc/PID/smaps_rollup, whose sizes are in kB of 1,024 bytes."""
    out = {}
    for line in text.splitlines():
        name, _, rest = line.partition(":")
        if name in MEMORY:
            size, unit = rest.split()
            if unit != "kB":
                raise ValueError(f"smaps_rollup: {name} is in {unit}, not in kB")
            out[MEMORY[name]] = int(size) * 1024 / 1e6
    if missing := set(MEMORY.values()) - set(out):
        raise ValueError(f"smaps_rollup has no {', '.join(sorted(missing))}")
    return out


def read_process(pid: int) -> dict:
    folder = pathlib.Path("/proc") / str(pid)
    out = read_memory((folder / "smaps_rollup").read_text())
    out["descriptors"] = len(os.listdir(folder / "fd"))
    out["threads"] = len(os.listdir(folder / "task"))
    return out
