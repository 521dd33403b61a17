#!/usr/bin/env python3
"""Writes the C++ form of a scene from scene.proto: plain structs without Protobuf, and their conversion.

    scene_types.py structs scene.proto OUT.h               spindrift::core::Scene and all that it holds
    scene_types.py conversion scene.proto OUT.h OUT.cpp    spindrift::scene::toCore() of each message and enum

In scene.proto                                       In C++
optional double side_m = 2 [(parameter) = {...}];    double side_m = 24.0;                        the option `default`
Stencil stencil = 5;                                 Stencil stencil = Stencil::kFivePoint;       the value 1
optional Side side = 1;                              std::optional<Side> side;
WaveScene wave = 9;                                  std::optional<WaveScene> wave;
repeated Beach beaches = 16;                         std::vector<Beach> beaches;
message Obstacle { oneof shape {...} }               using Obstacle = std::variant<Rock, Breakwater>;
message WaveMaker { ... oneof waves {...} }          struct WaveMaker { ... std::variant<...> waves; };

Comments, help texts and ranges become comments. A line in another form than those of scene.proto is an error.
"""

import argparse
import collections
import pathlib
import re
import sys
import textwrap

# What differs from these rules.
HOST_ONLY = {"Scene.fidelity", "Scene.unwatched", "Scene.setting", "Scene.water_type", "Scene.first_view",
             "Scene.restart_after_s", "ElevationSeries.file"}
ALWAYS_PRESENT = {"Scene.stream"}
INITIAL = {"Scene.seed": "1"}
BY_HAND = {"DepthGrid"}  # core/depth_grid.h; toCore() in scene_convert.cpp
CONVERSION = {"Scene": "fieldsToCore"}  # toCore() in scene_convert.cpp finishes it

COMMENT = re.compile(r"// ?(.*)")
BLOCK = re.compile(r"\s*(message|enum|oneof) (\w+) \{")
VALUE = re.compile(r"\s+([A-Z]\w*) = \d+;(?:\s*// (.*))?")
FIELD = re.compile(r"\s+(optional |repeated |)(\w+) (\w+) = \d+(?: \[\(parameter\) = \{(.*)\}\])?;(?:\s*// (.*))?")
OPTION = re.compile(r'(\w+): ("(?:[^"\\]|\\.)*"|[^\s}]+)')
OTHER = re.compile(r"(syntax|package|import) .*|\s+reserved .*|")
SCALARS = {"bool": "bool", "double": "double", "string": "std::string", "uint32": "std::uint32_t",
           "uint64": "std::uint64_t"}
ZEROS = {"bool": " = false", "string": "", "uint32": " = 0", "uint64": " = 0"}
ORIGIN = "// Generated from scene.proto by server/core/scene_types.py."

# A message (members: fields and oneofs), a oneof (fields) or an enum (pairs of name and comment).
Block = collections.namedtuple("Block", "kind name comment members")
Field = collections.namedtuple("Field", "kind label type name options comment")


def read(proto):
    """Returns messages and enums by name. Raises ValueError for a line in an unknown form."""
    types, open_blocks, comment = {}, [], []
    for number, line in enumerate(proto.splitlines(), start=1):
        inside = open_blocks[-1] if open_blocks else None
        if found := COMMENT.fullmatch(line):
            comment.append(found[1])
            continue
        if found := BLOCK.fullmatch(line):
            block = Block(found[1], found[2], comment, [])
            open_blocks.append(block)
            if inside:
                inside.members.append(block)
            else:
                types[block.name] = block
        elif inside and line.strip() == "}":
            open_blocks.pop()
        elif inside and inside.kind == "enum" and (found := VALUE.fullmatch(line)):
            inside.members.append((found[1], found[2] or ""))
        elif inside and inside.kind != "enum" and (found := FIELD.fullmatch(line)):
            options = {key: value.strip('"') for key, value in OPTION.findall(found[4] or "")}
            if found[4] and not {"label", "unit", "min", "max", "default"} <= options.keys():
                raise ValueError(f"line {number}: a parameter has label, unit, min, max and default")
            inside.members.append(Field("field", found[1].strip(), found[2], found[3], options, found[5] or ""))
        elif not OTHER.fullmatch(line):
            raise ValueError(f"line {number}: in no form that scene_types.py reads: {line.strip()}")
        comment = []
    return types


class Scene:
    """The messages and enums that core::Scene consists of, each after those that it holds."""

    def __init__(self, types):
        self.types, self.order, self.fields = types, [], set()
        self.visit("Scene")
        unknown = (HOST_ONLY | ALWAYS_PRESENT | INITIAL.keys()) - self.fields | BY_HAND - types.keys()
        if unknown:
            raise ValueError(f"scene_types.py names {', '.join(sorted(unknown))}, which scene.proto does not have")

    def visit(self, name):
        if name not in self.types:
            raise ValueError(f"{name} is a type that scene_types.py does not know")
        block = self.types[name]
        if block in self.order:
            return
        if block.kind == "message" and name not in BY_HAND:
            for member in block.members:
                for field in member.members if member.kind == "oneof" else [member]:
                    self.fields.add(f"{name}.{field.name}")
                    if field.type not in SCALARS and f"{name}.{field.name}" not in HOST_ONLY:
                        self.visit(field.type)
        self.order.append(block)

    def generated(self):
        return [block for block in self.order if block.name not in BY_HAND]

    def members(self, block):
        return [member for member in block.members if f"{block.name}.{member.name}" not in HOST_ONLY]

    def is_enum(self, field):
        return field.type in self.types and self.types[field.type].kind == "enum"

    def is_variant(self, block):
        return block.kind == "message" and [member.kind for member in block.members] == ["oneof"]


def constant(name):
    return "k" + "".join(map(str.capitalize, name.split("_")))


def values(enum):
    """Returns (name in proto, name in C++, comment) of each value but UNSPECIFIED."""
    prefix = enum.members[0][0].removesuffix("UNSPECIFIED")
    return [(name, constant(name.removeprefix(prefix)), comment) for name, comment in enum.members[1:]]


def variant(oneof):
    return f"std::variant<{', '.join(field.type for field in oneof.members)}>"


def documented(text, line):
    return textwrap.wrap(text, 118, initial_indent="  /// ", subsequent_indent="  /// ") + ["  " + line]


def documentation(field):
    if not field.options:
        return field.comment
    o = field.options
    bounds = f"{o['min']} to {o['max']} {o['unit']}".strip()
    return f"{o.get('help', o['label'])} [{bounds}] {field.comment}"


def declaration(scene, message, field):
    path, kind = f"{message.name}.{field.name}", SCALARS.get(field.type, field.type)
    if field.label == "repeated":
        return f"std::vector<{kind}> {field.name};"
    if field.options:
        is_whole_double = field.type == "double" and re.fullmatch(r"-?\d+", field.options["default"])
        return f"{kind} {field.name} = {field.options['default']}{'.0' if is_whole_double else ''};"
    if field.type in SCALARS:
        return f"{kind} {field.name}{f' = {INITIAL[path]}' if path in INITIAL else ZEROS[field.type]};"
    if scene.is_enum(field) and field.label != "optional":
        return f"{kind} {field.name} = {kind}::{values(scene.types[kind])[0][1]};"
    if path in ALWAYS_PRESENT or scene.is_variant(scene.types[kind]):
        return f"{kind} {field.name};"
    return f"std::optional<{kind}> {field.name};"


def structs(scene):
    lines = [ORIGIN, "#pragma once", ""]
    lines += [f"#include <{name}>" for name in ("cstdint", "optional", "string", "variant", "vector")]
    lines += ["", "#include <spindrift/core/depth_grid.h>", "", "namespace spindrift::core {"]
    for block in scene.generated():
        lines += ["", *(f"/// {line}" for line in block.comment)]
        if block.kind == "enum":
            lines += [f"enum class {block.name} {{"]
            for _, name, comment in values(block):
                lines += documented(comment, f"{name},")
            lines += ["};"]
        elif scene.is_variant(block):
            lines += [f"using {block.name} = {variant(block.members[0])};"]
        else:
            lines += [f"struct {block.name} {{"]
            for member in scene.members(block):
                if member.kind == "oneof":
                    lines += [f"  {variant(member)} {member.name};"]
                else:
                    lines += documented(documentation(member), declaration(scene, block, member))
            lines += ["", f"  bool operator==(const {block.name}&) const = default;", "};"]
    return lines + ["", "}  // namespace spindrift::core"]


def conversion(scene, block, member):
    """Returns the statements that convert a field or a oneof."""
    name = member.name
    if member.kind == "oneof":
        out = "out" if scene.is_variant(block) else f"out.{name}"
        lines = [f"switch (in.{name}_case()) {{"]
        for field in member.members:
            lines += [f"  case v1::{block.name}::{constant(field.name)}:"]
            lines += [f"    {out} = toCore(in.{field.name}());", "    break;"]
        return lines + [f"  case v1::{block.name}::{name.upper()}_NOT_SET:", "    break;", "}"]
    if member.label == "repeated" and member.type in SCALARS:
        return [f"out.{name}.assign(in.{name}().begin(), in.{name}().end());"]
    if member.label == "repeated":
        return [f"for (const auto& each : in.{name}()) out.{name}.push_back(toCore(each));"]
    value = f"in.{name}()" if member.type in SCALARS else f"toCore(in.{name}())"
    if scene.is_enum(member) and member.label == "optional":
        return [f"if (in.{name}() != v1::{scene.types[member.type].members[0][0]}) out.{name} = {value};"]
    if f"{block.name}.{name}" in INITIAL:
        return [f"if (in.{name}() != 0) out.{name} = {value};"]
    has_presence = member.label == "optional" or member.type not in SCALARS and not scene.is_enum(member)
    return [(f"if (in.has_{name}()) " if has_presence else "") + f"out.{name} = {value};"]


def signature(block):
    parameter = f"v1::{block.name} in" if block.kind == "enum" else f"const v1::{block.name}& in"
    return f"core::{block.name} {CONVERSION.get(block.name, 'toCore')}({parameter})"


def conversions(scene):
    header = [ORIGIN, "#pragma once", "", "#include <spindrift/core/scene.h>", "#include <spindrift/v1/scene.pb.h>", "",
              "namespace spindrift::scene {", "",
              "/// Convert to the simulation's form. Fields left out get their defaults.",
              *(signature(block) + ";" for block in scene.order), "", "}  // namespace spindrift::scene"]
    source = [ORIGIN, "#include <spindrift/scene/to_core.h>", "", "namespace spindrift::scene {", ""]
    for block in scene.generated():
        source += [signature(block) + " {"]
        if block.kind == "enum":
            first, *others = values(block)
            source += ["  switch (in) {"]
            for proto, name, _ in others:
                source += [f"    case v1::{proto}:", f"      return core::{block.name}::{name};"]
            source += ["    default:", f"      return core::{block.name}::{first[1]};", "  }"]
        else:
            source += [f"  core::{block.name} out;"]
            for member in scene.members(block):
                source += ["  " + line for line in conversion(scene, block, member)]
            source += ["  return out;"]
        source += ["}", ""]
    return header, source + ["}  // namespace spindrift::scene"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("structs", "conversion"))
    parser.add_argument("proto", type=pathlib.Path)
    parser.add_argument("outputs", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    try:
        scene = Scene(read(arguments.proto.read_text(encoding="utf-8")))
    except ValueError as error:
        sys.exit(f"{arguments.proto}: {error}")
    texts = [structs(scene)] if arguments.what == "structs" else conversions(scene)
    for output, lines in zip(arguments.outputs, texts, strict=True):
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
