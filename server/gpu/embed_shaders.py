#!/usr/bin/env python3
"""Expands, validates and embeds the compute shaders.

Every *.comp below the root is an entry point. `#include "a/b.h"` is relative to the root. Each file is included once per
entry point, even where several `#if` blocks include it; a cycle is refused. Shaders have no `#version` line: this script
puts it and the defines before the text for validation, and the program does so before compiling.

variants.txt in the root lists every entry point, and below it one indented line for each set of defines, `A=1 B=2`. Each
set is validated as GLSL and as the SPIR-V that glslc generates from it. An entry point without such lines is validated
once, without defines. Refused: an entry point that is not listed, and a define that its shader does not use.

Files in shared/ are C++ headers as well: `#pragma once` and includes under `#ifdef __cplusplus` are left out.
The result is one C++ source with the expanded texts and, for each text, the files and lines that it comes from,
the names that defines may set, and a digest.
"""

import argparse
import concurrent.futures
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

VERSION_LINE = "#version 450 core"  # the same as in compiled_program.cpp
INCLUDE = re.compile(r'\s*#\s*include\b\s*(.*)')
QUOTED = re.compile(r'"([^"]+)"\s*(//.*)?$')
GUARD = re.compile(r"(\s*//[^\n]*\n|\s)*#ifndef (\w+)\n#define \2\n")
DELIMITER = "SPINDRIFT_GLSL"
TABLE = "variants.txt"
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


class ShaderError(Exception):
    """A message of one line: file, line, what is wrong."""


class Expansion:
    """The text of one entry point with its includes, and the file and line that each of its lines comes from."""

    def __init__(self, root, entry, shared=None):
        self.folders = [root, shared or root]
        self.entry = entry
        self.lines = []
        self.origins = []
        self.files = []
        self._certain = set()  # files that are included with every set of defines
        self._expand(entry, [], is_certain=True)

    def _expand(self, name, stack, is_certain):
        """`is_certain`: the place is not inside an #if."""
        if name in stack:
            raise ShaderError("include cycle: " + " -> ".join(stack[stack.index(name):] + [name]))
        self.files.append(name)
        if is_certain:
            self._certain.add(name)
        try:
            text = self.path(name).read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise ShaderError(f"{name}: not UTF-8: {error}") from error
        if DELIMITER in text:
            raise ShaderError(f"{name}: contains the reserved word {DELIMITER}")
        conditions = []  # one per open #if: True if its lines are for C++ only
        guard_depth = 1 if GUARD.match(text) else 0  # the file's own include guard does not count as a condition
        for number, line in enumerate(text.splitlines(), start=1):
            where = f"{name}:{number}"
            directive = re.sub(r"\s+", "", line)
            if directive.startswith("#version"):
                raise ShaderError(f"{where}: remove #version, the program puts it first")
            if directive.startswith("#if"):
                conditions.append(directive in ("#ifdef__cplusplus", "#ifdefined(__cplusplus)"))
            elif directive.startswith("#else") and conditions:
                # The #else of a C++-only block is for GLSL. `#ifndef __cplusplus … #else` is not supported: no file needs it.
                conditions[-1] = False
            elif directive.startswith("#endif") and conditions:
                conditions.pop()
            if directive.startswith("#pragmaonce"):
                self._add("", name, number)
                continue
            include = INCLUDE.match(line)
            if not include:
                self._add(line, name, number)
            elif any(conditions):
                self._add("", name, number)
            else:
                self._include(include.group(1), where, name, number, stack + [name],
                              is_certain and len(conditions) <= guard_depth)

    def _include(self, what, where, name, number, stack, is_certain):
        quoted = QUOTED.match(what)
        if not quoted:
            raise ShaderError(f'{where}: write #include "file", relative to the shader root, instead of: {what}')
        included = quoted.group(1)
        if ".." in included.split("/") or not self.path(included).is_file():
            raise ShaderError(f'{where}: no file "{included}" below the shader root')
        if included in self._certain and included not in stack:
            self._add("", name, number)
            return
        if is_certain and included not in self.files:
            self._expand(included, stack, is_certain)
            return
        # Several places may include the file under conditions: the first one that the preprocessor reaches includes it.
        once = "SPINDRIFT_ONCE_" + re.sub(r"\W", "_", included)
        self._add(f"#ifndef {once}", name, number)
        self._add(f"#define {once}", name, number)
        self._expand(included, stack, is_certain)
        self._add("#endif", name, number)

    def path(self, name):
        return next((folder / name for folder in self.folders if (folder / name).is_file()), self.folders[0] / name)

    def _add(self, line, name, number):
        self.lines.append(line)
        self.origins.append((name, number))

    def text(self):
        return "\n".join(self.lines) + "\n"

    def ranges(self):
        """(first line, file, line in file) of each run of lines that follow each other in one file."""
        runs = []
        for index, (name, number) in enumerate(self.origins):
            if index == 0 or self.origins[index - 1] != (name, number - 1):
                runs.append((index + 1, name, number))
        return runs

    def position(self, line):
        if 1 <= line <= len(self.origins):
            return "{}:{}".format(*self.origins[line - 1])
        return f"{self.entry}:{line} of the expanded text"

    def unused(self, defines):
        """Names in the set of defines that the shader's text does not contain outside comments."""
        return [name for name, _ in defines if name not in self.names()]

    def names(self):
        """Words in capitals outside comments: what a define can change."""
        return set(re.findall(r"\b[A-Z][A-Z0-9_]*\b", COMMENT.sub(" ", self.text())))


def read_variants(root, entries):
    """Reads the table of variants: for each entry point a list of (line number, set of defines), a set being a list of
    (name, value)."""
    path = root / TABLE
    if not path.is_file():
        raise ShaderError(f"{TABLE}: missing; it lists every shader with its sets of defines")
    table = {}
    entry = None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        text = line.split("#")[0].rstrip()
        where = f"{TABLE}:{number}"
        if not text:
            continue
        if text[0].isspace():
            if entry is None:
                raise ShaderError(f"{where}: defines before the first shader")
            table[entry].append((number, parse_defines(text, where, entry)))
            continue
        entry = text
        if entry in table:
            raise ShaderError(f"{where}: {entry} is listed a second time")
        if entry not in entries:
            raise ShaderError(f"{where}: no shader {entry}")
        table[entry] = []
    return table


def parse_defines(text, where, entry):
    defines = []
    for word in text.split():
        match = re.fullmatch(r"([A-Z][A-Z0-9_]*)=(\S+)", word)
        if not match:
            raise ShaderError(f"{where}: {entry}: write NAME=VALUE, the name in capitals, instead of {word}")
        defines.append(match.groups())
    return defines


def variants_of(expansion, table):
    """Returns the sets of defines with which to validate the shader."""
    if expansion.entry not in table:
        raise ShaderError(f"{expansion.entry}: not listed in {TABLE}")
    sets = table[expansion.entry]
    for number, defines in sets:
        if unused := expansion.unused(defines):
            raise ShaderError(f"{TABLE}:{number}: {expansion.entry} does not use {', '.join(unused)}")
    return [defines for _, defines in sets] or [[]]


def in_folder(folder, *command):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def validate(tools, jobs):
    """Returns what the compiler reports about the GLSL of each (expansion, defines), or the validator about the SPIR-V that the
    compiler generates: one string per message, with the file and line of the source where known. The list is empty when all
    are valid. One process compiles a whole share of the jobs: its start costs more than a shader."""
    shares = [range(first, len(jobs), os.cpu_count()) for first in range(min(os.cpu_count(), len(jobs)))]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor() as pool:
        found = [[] for _ in jobs]
        for index, (expansion, defines) in enumerate(jobs):
            head = [VERSION_LINE] + [f"#define {name} {value}" for name, value in defines] + ["#line 1"]
            pathlib.Path(folder, f"{index}.comp").write_text("\n".join(head) + "\n" + expansion.text(), encoding="utf-8")
        # Plain uniforms have no location in our GLSL, but need one in SPIR-V.
        options = ["-c", "--target-env=opengl", "-fauto-map-locations"]
        for run in pool.map(lambda share: in_folder(folder, tools.glslc, *options, *(f"{index}.comp" for index in share)), shares):
            for line in (run.stdout + run.stderr).splitlines():
                match = re.match(r"(\d+)\.comp:(?:(\d+):)? (error|warning): (.*)", line)
                if match:
                    index = int(match.group(1))
                    position = jobs[index][0].position(int(match.group(2) or 0))
                    found[index].append(f"{position}: {match.group(3)}: {match.group(4)}")
        compiled = [index for index in range(len(jobs)) if not found[index]]
        options = ["--target-env", "opengl4.5"]
        for index, run in zip(compiled, pool.map(
                lambda index: in_folder(folder, tools.spirv_val, *options, f"{index}.comp.spv"), compiled)):
            if run.returncode != 0:
                found[index] = [f"{jobs[index][0].entry}: SPIR-V: {line.strip()}" for line in (run.stdout + run.stderr).splitlines()]
    complaints = []
    for (expansion, defines), said in zip(jobs, found):
        if said:
            variant = " ".join(f"{name}={value}" for name, value in defines) or "no defines"
            complaints += said + [f"{expansion.entry}: not valid with {variant}"]
    return complaints


def depfile_path(path):
    """Escapes a path for a make-style rule."""
    return re.sub(r"([ #])", r"\\\1", str(path)).replace("$", "$$")


def cpp_source(expansions, function):
    parts = ["// Generated by embed_shaders.py.\n#include <array>\n\n#include <spindrift/gpu/embedded_shader.h>\n\n"
             "namespace spindrift::gpu {\nnamespace {\n\n"]
    for index, expansion in enumerate(expansions):
        runs = "".join(f'    LineRange{{{first}, "{name}", {number}}},\n' for first, name, number in expansion.ranges())
        parts.append(f"constexpr auto kLines{index} = std::to_array<LineRange>({{\n{runs}}});\n")
        names = "".join(f'    "{name}",\n' for name in sorted(expansion.names()))
        parts.append(f"constexpr std::array<std::string_view, {len(expansion.names())}> kNames{index} = {{\n{names}}};\n")
        # The newline after the opening parenthesis is not part of the text.
        parts.append(f"constexpr std::string_view kText{index} =\n"
                     f'    std::string_view(R"{DELIMITER}(\n{expansion.text()}){DELIMITER}").substr(1);\n\n')
    parts.append(f"constexpr std::array<EmbeddedShader, {len(expansions)}> kShaders = {{{{\n")
    for index, expansion in enumerate(expansions):
        digest = hashlib.sha256(expansion.text().encode()).hexdigest()
        parts.append(f'    EmbeddedShader{{"{expansion.entry}", kText{index}, kLines{index}, kNames{index}, "{digest}"}},\n')
    parts.append("}};\n\n}  // namespace\n\n"
                 f"std::span<const EmbeddedShader> {function}();\n"
                 f"std::span<const EmbeddedShader> {function}() {{ return kShaders; }}\n\n"
                 "}  // namespace spindrift::gpu\n")
    return "".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, required=True, help="folder of the shaders")
    parser.add_argument("--shared", type=pathlib.Path, help="folder of more files to include, with another root")
    parser.add_argument("--function", default="embeddedShaders", help="name of the function that returns the shaders")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="C++ source to write")
    parser.add_argument("--depfile", type=pathlib.Path, help="make-style list of the files read")
    parser.add_argument("--glslc", default="glslc", help="compiler to run")
    parser.add_argument("--spirv-val", default="spirv-val", help="validator of SPIR-V to run")
    arguments = parser.parse_args()

    root = arguments.root.resolve()
    entries = sorted(path.relative_to(root).as_posix() for path in root.rglob("*.comp"))
    expansions, jobs, problems = [], [], []
    try:
        table = read_variants(root, entries)
    except ShaderError as error:
        print(error, file=sys.stderr)
        return 1
    for entry in entries:
        try:
            expansion = Expansion(root, entry, arguments.shared and arguments.shared.resolve())
            jobs += [(expansion, defines) for defines in variants_of(expansion, table)]
            expansions.append(expansion)
        except ShaderError as error:
            problems.append(str(error))
    try:
        problems += validate(arguments, jobs)
    except FileNotFoundError as error:
        problems.append(f"{error.filename} not found: install glslc and spirv-tools")
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 1

    arguments.output.write_text(cpp_source(expansions, arguments.function), encoding="utf-8")
    if arguments.depfile:
        files = sorted({root / TABLE} | {expansion.path(name) for expansion in expansions for name in expansion.files})
        rule = depfile_path(arguments.output) + ": " + " ".join(depfile_path(path) for path in files)
        arguments.depfile.write_text(rule + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
