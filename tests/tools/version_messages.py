"""Writes tests/golden/versions.txt: messages of every minor version of the wire, made from the proto files that the version had.

    python3 tests/tools/version_messages.py 1.0=COMMIT 1.1=COMMIT ... > tests/golden/versions.txt

COMMIT: the last one of the repository whose README of proto/ says "this is 1.N". Every field of a message is set, by the options of the
version where they have bounds; a scene has its name and a wave. Needs git, protoc and the Python library of Protobuf.
"""
import pathlib
import subprocess
import sys
import tempfile

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from google.protobuf.descriptor import FieldDescriptor

# Set as a server would: what the rules of the wire say about them is not in the options.
TEXTS = {"go_to": "ws://other.example:8080", "path": "wave.damping_per_s"}
FRAMES = "frame"  # tests/golden has frames of its own


def schema(commit, folder):
    """The messages of a commit by name."""
    archive = subprocess.run(["git", "archive", commit, "proto"], check=True, capture_output=True).stdout
    subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
    proto, out = pathlib.Path(folder) / "proto", pathlib.Path(folder) / "set"
    subprocess.run(["protoc", f"--proto_path={proto}", "--include_imports", f"--descriptor_set_out={out}", "spindrift/v1/wire.proto"], check=True)
    files = descriptor_pb2.FileDescriptorSet.FromString(out.read_bytes())
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)

    def find(name):
        return message_factory.MessageFactory(pool).GetPrototype(pool.FindMessageTypeByName(f"spindrift.v1.{name}"))

    options = message_factory.MessageFactory(pool).GetPrototype(pool.FindMessageTypeByName("google.protobuf.FieldOptions"))
    bounds = pool.FindExtensionByName("spindrift.v1.parameter")
    return find, options, bounds


class Filler:
    def __init__(self, commit, folder):
        self.find, self._options, self._bounds = schema(commit, folder)

    def number(self, field):
        """Within the bounds that the field has."""
        options = self._options.FromString(field.GetOptions().SerializeToString())
        if not options.HasExtension(self._bounds):
            return 1
        parameter = options.Extensions[self._bounds]
        return parameter.default or min(max(1, parameter.min), parameter.max)

    def value(self, field):
        if field.type == FieldDescriptor.TYPE_ENUM:
            numbers = [value.number for value in field.enum_type.values]
            return numbers[min(1, len(numbers) - 1)]
        if field.type == FieldDescriptor.TYPE_STRING:
            return TEXTS.get(field.name, field.name)
        if field.type == FieldDescriptor.TYPE_BYTES:
            return b"\1"
        if field.type == FieldDescriptor.TYPE_BOOL:
            return True
        number = self.number(field)
        return number if field.cpp_type in (FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT) else int(number)

    def fill(self, message):
        chosen = set()
        for field in message.DESCRIPTOR.fields:
            oneof = field.containing_oneof
            if oneof is not None and len(oneof.fields) > 1:
                if oneof.name in chosen:
                    continue
                chosen.add(oneof.name)
            if field.message_type is not None and field.message_type.full_name == "spindrift.v1.Scene":
                scene = getattr(message, field.name)
                scene.name = "scene"
                scene.wave.resolution_count, scene.wave.side_m, scene.wave.depth_m = 32, 8, 1
            elif field.message_type is not None:
                inner = getattr(message, field.name)
                self.fill(inner.add() if field.label == FieldDescriptor.LABEL_REPEATED else inner)
            elif field.label == FieldDescriptor.LABEL_REPEATED:
                getattr(message, field.name).append(self.value(field))
            else:
                setattr(message, field.name, self.value(field))


def messages(minor, filler):
    """(side, kind, bytes) of everything that a server and a client of the version say."""
    server, client = filler.find("ServerMessage"), filler.find("ClientMessage")
    version = {"major": 1, "minor": minor}
    for field in server.DESCRIPTOR.oneofs_by_name["message"].fields:
        if field.name == FRAMES:
            continue
        message = server()
        body = getattr(message, field.name)
        body.SetInParent()
        filler.fill(body)
        if field.name == "greeting":
            body.version.major, body.version.minor = version["major"], version["minor"]
        yield "server", field.name, message.SerializeToString(deterministic=True)
    for field in client.DESCRIPTOR.oneofs_by_name["message"].fields:
        actions = field.message_type.oneofs_by_name["action"].fields if field.name == "command" else [None]
        for action in actions:
            message = client()
            body = getattr(message, field.name)
            body.SetInParent()
            if action is None:
                filler.fill(body)
            else:
                body.command_id = 1
                getattr(body, action.name).SetInParent()
                filler.fill(getattr(body, action.name))
            if field.name == "hello":
                body.version.major, body.version.minor = version["major"], version["minor"]
            yield "client", action.name if action else field.name, message.SerializeToString(deterministic=True)


def main():
    print("# Messages of every minor version of the wire: version, side that sends it, kind, bytes; a version has the messages that are new or that differ")
    print("# from the version before. Made by tests/tools/version_messages.py.")
    said = {}
    for argument in sys.argv[1:]:
        version, commit = argument.split("=")
        with tempfile.TemporaryDirectory() as folder:
            for side, kind, data in messages(int(version.split(".")[1]), Filler(commit, folder)):
                if said.get((side, kind)) != data:
                    print(version, side, kind, data.hex())
                said[side, kind] = data


if __name__ == "__main__":
    main()
