"""Commands by name: every action of wire.Command becomes a method, whose arguments are the fields of its message."""
from __future__ import annotations

from .v1 import options_pb2 as options
from .v1 import wire_pb2 as wire

_ACTIONS = wire.Command.DESCRIPTOR.oneofs_by_name["action"].fields
ACTIONS = tuple(action.name for action in _ACTIONS)


def build(action: str, fields: dict) -> wire.Command:
    """A command without its id. Enums may be given by the end of their name ("minus_x"), and the fields of a single inner
    message (the boat of spawn_boat) directly. Raises TypeError for a field that the action does not have."""
    if action not in ACTIONS:
        raise TypeError(f"there is no command {action!r}; there are {', '.join(ACTIONS)}")
    command = wire.Command()
    message = getattr(command, action)
    message.SetInParent()
    _fill(message, fields, action)
    return command


def _fill(message, fields, path):
    for name, value in fields.items():
        field, owner = _field(message, name)
        if field is None:
            raise TypeError(f"{path} has no {name!r}; it has {', '.join(_names(message.DESCRIPTOR))}")
        _set(owner, field, value, f"{path}.{name}")


def _field(message, name):
    """The field and the message that has it: the given one, or an inner message of it."""
    found = message.DESCRIPTOR.fields_by_name.get(name)
    if found is not None:
        return found, message
    for inner in _inner(message.DESCRIPTOR):
        if name in inner.message_type.fields_by_name:
            return inner.message_type.fields_by_name[name], getattr(message, inner.name)
    return None, message


def _inner(descriptor):
    return [field for field in descriptor.fields if field.message_type is not None and field.label != field.LABEL_REPEATED]


def _names(descriptor):
    for field in descriptor.fields:
        yield from _names(field.message_type) if field in _inner(descriptor) else (field.name,)


def _set(message, field, value, path):
    if field.label == field.LABEL_REPEATED:
        for each in value:
            if field.message_type is None:
                getattr(message, field.name).append(_number(field, each))
            else:
                _fill(getattr(message, field.name).add(), each, path)
    elif field.message_type is None:
        setattr(message, field.name, _number(field, value))
    elif isinstance(value, dict):
        getattr(message, field.name).SetInParent()
        _fill(getattr(message, field.name), value, path)
    else:
        getattr(message, field.name).CopyFrom(value)


def _number(field, value):
    if field.enum_type is None or not isinstance(value, str):
        return value
    wanted = value.upper()
    for name, number in field.enum_type.values_by_name.items():
        if name == wanted or name.endswith(f"_{wanted}"):
            return number.number
    raise TypeError(f"{field.name} cannot be {value!r}; it can be {', '.join(field.enum_type.values_by_name)}")


def describe(action) -> str:
    """One line per field: its unit and bounds as the server checks them."""
    lines = [f"Sends {action.name}; returns its Ack, or raises Rejected, ConnectionLost or NoAnswer.", ""]

    def add(descriptor):
        for field in descriptor.fields:
            if field in _inner(descriptor):
                add(field.message_type)
                continue
            limits = field.GetOptions().Extensions[options.parameter]
            text = f"    {field.name}"
            if field.enum_type is not None:
                text += f": {', '.join(field.enum_type.values_by_name)}"
            elif limits.label:
                text += f": {limits.label}, {limits.min:g} to {limits.max:g} {limits.unit}".rstrip()
                text += f"; {limits.default:g} if left out" if field.has_presence else ""
                text += f". {limits.help}" if limits.help else ""
            lines.append(text)

    add(action.message_type)
    return "\n".join(lines)


def add_methods(cls):
    """Gives a class with `command(action, **fields)` a method for each action that it has none for, with a docstring made from the wire's own options."""
    for action in _ACTIONS:
        def method(self, _name=action.name, **fields):
            return self.command(_name, **fields)

        method.__name__ = method.__qualname__ = action.name
        method.__doc__ = describe(action)
        if action.name not in vars(cls):
            setattr(cls, action.name, method)
    return cls
