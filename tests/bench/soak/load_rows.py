"""Reads the rows that `spindrift-bench --suite soak` prints while it runs."""


def newest_row(text: str) -> dict:
    """Returns {column: number} of the last whole row under the heading; empty before the first one."""
    lines = text.split("\n")[:-1]  # what has no line break yet is not whole
    heading = next((k for k, line in enumerate(lines) if line.split()[:2] == ["time_s", "open"]), None)
    if heading is None:
        return {}
    names = lines[heading].split()
    for line in reversed(lines[heading + 1 :]):
        fields = line.split()
        if len(fields) != len(names):
            continue
        try:
            return {name: float(field) for name, field in zip(names, fields)}
        except ValueError:
            continue  # the table at the end
    return {}
