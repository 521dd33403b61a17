"""Parameters of the capacity model: a JSON file of named values, each with its unit, its meaning and its source."""
import json
import pathlib

DEFAULT_FILE = pathlib.Path(__file__).with_name("capacity_parameters.json")


class ParameterError(Exception):
    """A parameter that is missing, unknown or outside of its bounds. One line that says what to do."""


class Parameters:
    """Read access to the values by name. A value that was not measured yet is an error, not a guess."""

    def __init__(self, entries: dict, name: str):
        self.entries = entries
        self.name = name

    @staticmethod
    def load(path: pathlib.Path) -> "Parameters":
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise ParameterError(f"{path}: {error.strerror}: give --parameters FILE") from error
        except json.JSONDecodeError as error:
            raise ParameterError(f"{path}:{error.lineno}: no JSON: {error.msg}") from error
        for name, entry in content.items():
            if set(entry) != {"unit", "value", "meaning", "source"}:
                raise ParameterError(f"{path}: {name} has the fields {sorted(entry)}: it needs unit, value, meaning and source")
        return Parameters(content, str(path))

    def save(self, path: pathlib.Path):
        path.write_text(json.dumps(self.entries, indent=2) + "\n", encoding="utf-8")

    def missing(self) -> list[str]:
        return [name for name, entry in self.entries.items() if entry["value"] is None]

    def set(self, name: str, value, source: str):
        if name not in self.entries:
            raise ParameterError(f"{self.name}: there is no parameter {name}")
        self.entries[name]["value"] = value
        self.entries[name]["source"] = source

    def __getitem__(self, name: str):
        if name not in self.entries:
            raise ParameterError(f"{self.name}: {name} is missing: add it with unit, value, meaning and source")
        value = self.entries[name]["value"]
        if value is None:
            raise ParameterError(
                f"{self.name}: {name} was not measured yet: run capacity_measure.py --program PATH --write FILE"
            )
        if isinstance(value, (int, float)) and not value >= 0:
            raise ParameterError(f"{self.name}: {name} is {value}: it has to be 0 or more")
        return value
