#!/usr/bin/env python3
"""Expands, validates and embeds the compute shaders.

Every *.comp below the root is an entry point. `#include "a/b.h"` is relative to the root, each file counts once per
entry point, also where one of several places that include it lies inside of an `#if`; a cycle is refused. Shaders carry no `#version`: it and the defines are put before the text, here for
validation and in the program before compiling. A comment `// variants: A=1 B=2 | A=3` among an entry point's leading
comments lists the sets of defines to validate, as GLSL and as the SPIR-V that glslang
makes of it; without it one empty set is.
Files in shared/ are C++ headers as well: `#pragma once` and whatever is included under `#ifdef __cplusplus` is left out.
The result is one C++ source with the expanded texts and, for each, where its lines come from.
"""

import argparse
import concurrent.futures
import pathlib
import re
import subprocess
import sys
import tempfile

VERSION_LINE = "#version 450 core"  # the same as in program.cpp
INCLUDE = re.compile(r'\s*#\s*include\b\s*(.*)')
QUOTED = re.compile(r'"([^"]+)"\s*(//.*)?$')
GUARD = re.compile(r"(\s*//[^\n]*\n|\s)*#ifndef (\w+)\n#define \2\n")
DELIMITER = "SPINDRIFT_GLSL"


class ShaderError(Exception):
    """One line for a person: file, line, what is wrong."""


class Expansion:
    """The text of one entry point with its includes, and the file and line that each of its lines comes from."""

    def __init__(self, root, entry):
        self.root = root
        self.entry = entry
        self.lines = []
        self.origins = []
        self.files = []
        self._certain = set()  # files that are there whatever the defines
        self._expand(entry, [], is_certain=True)

    def _expand(self, name, stack, is_certain):
        """`is_certain`: no condition lies around this place."""
        if name in stack:
            raise ShaderError("include cycle: " + " -> ".join(stack[stack.index(name):] + [name]))
        self.files.append(name)
        if is_certain:
            self._certain.add(name)
        try:
            text = (self.root / name).read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise ShaderError(f"{name}: not UTF-8: {error}") from error
        if DELIMITER in text:
            raise ShaderError(f"{name}: contains the reserved word {DELIMITER}")
        conditions = []  # for each open #if: whether its lines are for C++ only
        guard_depth = 1 if GUARD.match(text) else 0  # the file's own guard is no condition
        for number, line in enumerate(text.splitlines(), start=1):
            where = f"{name}:{number}"
            directive = re.sub(r"\s+", "", line)
            if directive.startswith("#version"):
                raise ShaderError(f"{where}: remove #version, the program puts it first")
            if directive.startswith("#if"):
                conditions.append(directive in ("#ifdef__cplusplus", "#ifdefined(__cplusplus)"))
            elif directive.startswith("#else") and conditions:
                # Of a C++-only block the other branch is not; `#ifndef __cplusplus … #else` is not needed anywhere.
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
        if ".." in included.split("/") or not (self.root / included).is_file():
            raise ShaderError(f'{where}: no file "{included}" below the shader root')
        if included in self._certain and included not in stack:
            self._add("", name, number)
            return
        if is_certain and included not in self.files:
            self._expand(included, stack, is_certain)
            return
        # Of several places that include a file under conditions the first whose condition holds counts.
        once = "SPINDRIFT_ONCE_" + re.sub(r"\W", "_", included)
        self._add(f"#ifndef {once}", name, number)
        self._add(f"#define {once}", name, number)
        self._expand(included, stack, is_certain)
        self._add("#endif", name, number)

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

    def variants(self):
        """Sets of defines to validate, each a list of (name, value)."""
        for line in (self.root / self.entry).read_text(encoding="utf-8").splitlines():
            if line.strip() and not line.lstrip().startswith("//"):
                break
            match = re.match(r"\s*//\s*variants:(.*)", line)
            if match:
                return [self._defines(part) for part in match.group(1).split("|")]
        return [[]]

    def _defines(self, part):
        defines = []
        for word in part.split():
            match = re.fullmatch(r"([A-Za-z_]\w*)=(\S+)", word)
            if not match:
                raise ShaderError(f"{self.entry}: variants: write NAME=VALUE instead of {word}")
            defines.append(match.groups())
        return defines


def validate(tools, expansion, defines):
    """Complaints of the compiler about the GLSL, or of the validator about the SPIR-V that it makes of it, one a line, with
    file and line as written where there are any; empty when the shader is valid."""
    head = [VERSION_LINE] + [f"#define {name} {value}" for name, value in defines] + ["#line 1"]
    with tempfile.TemporaryDirectory() as folder:
        module = pathlib.Path(folder) / "shader.spv"
        # -G: SPIR-V as OpenGL takes it. Plain uniforms need no location in our GLSL, but in SPIR-V: they get one here.
        run = subprocess.run([tools.glslang, "--stdin", "-S", "comp", "-G", "--auto-map-locations", "-o", module],
                             input="\n".join(head) + "\n" + expansion.text(), capture_output=True, text=True, check=False)
        spirv = None
        if run.returncode == 0:
            spirv = subprocess.run([tools.spirv_val, "--target-env", "opengl4.5", module], capture_output=True, text=True,
                                   check=False)
            if spirv.returncode == 0:
                return []
    complaints = []
    if spirv is not None:
        said = (spirv.stdout + spirv.stderr).splitlines()
        complaints = [f"{expansion.entry}: SPIR-V: {line.strip()}" for line in said if line.strip()]
        run.stdout = run.stderr = ""
    for line in (run.stdout + run.stderr).splitlines():
        match = re.match(r"(ERROR|WARNING): [^:]*:(\d+): (.*)", line)
        if match:
            complaints.append(f"{expansion.position(int(match.group(2)))}: {match.group(1).lower()}: {match.group(3)}")
        elif line.strip() and line.strip() != "stdin":
            complaints.append(f"{expansion.entry}: {line.strip()}")
    variant = " ".join(f"{name}={value}" for name, value in defines) or "no defines"
    return complaints + [f"{expansion.entry}: not valid with {variant}"]


def depfile_path(path):
    """A path as a make-style rule takes it."""
    return re.sub(r"([ #])", r"\\\1", str(path)).replace("$", "$$")


def cpp_source(expansions):
    parts = ["// Generated by embed_shaders.py.\n#include <array>\n\n#include <spindrift/gpu/embedded_shader.h>\n\n"
             "namespace spindrift::gpu {\nnamespace {\n\n"]
    for index, expansion in enumerate(expansions):
        runs = "".join(f'    LineRange{{{first}, "{name}", {number}}},\n' for first, name, number in expansion.ranges())
        parts.append(f"constexpr auto kLines{index} = std::to_array<LineRange>({{\n{runs}}});\n")
        # The newline after the opening parenthesis is not part of the text.
        parts.append(f"constexpr std::string_view kText{index} =\n"
                     f'    std::string_view(R"{DELIMITER}(\n{expansion.text()}){DELIMITER}").substr(1);\n\n')
    parts.append(f"constexpr std::array<EmbeddedShader, {len(expansions)}> kShaders = {{{{\n")
    for index, expansion in enumerate(expansions):
        parts.append(f'    EmbeddedShader{{"{expansion.entry}", kText{index}, kLines{index}}},\n')
    parts.append("}};\n\n}  // namespace\n\n"
                 "std::span<const EmbeddedShader> embeddedShaders() { return kShaders; }\n\n"
                 "}  // namespace spindrift::gpu\n")
    return "".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, required=True, help="folder of the shaders")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="C++ source to write")
    parser.add_argument("--depfile", type=pathlib.Path, help="make-style list of the files read")
    parser.add_argument("--glslang", default="glslangValidator", help="compiler to run")
    parser.add_argument("--spirv-val", default="spirv-val", help="validator of SPIR-V to run")
    arguments = parser.parse_args()

    root = arguments.root.resolve()
    entries = sorted(path.relative_to(root).as_posix() for path in root.rglob("*.comp"))
    expansions, jobs, problems = [], [], []
    for entry in entries:
        try:
            expansion = Expansion(root, entry)
            jobs += [(expansion, defines) for defines in expansion.variants()]
            expansions.append(expansion)
        except ShaderError as error:
            problems.append(str(error))
    try:
        with concurrent.futures.ThreadPoolExecutor() as pool:
            for complaints in pool.map(lambda job: validate(arguments, *job), jobs):
                problems += complaints
    except FileNotFoundError as error:
        problems.append(f"{error.filename} not found: install glslang-tools and spirv-tools")
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 1

    arguments.output.write_text(cpp_source(expansions), encoding="utf-8")
    if arguments.depfile:
        files = sorted({name for expansion in expansions for name in expansion.files})
        rule = depfile_path(arguments.output) + ": " + " ".join(depfile_path(root / name) for name in files)
        arguments.depfile.write_text(rule + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
