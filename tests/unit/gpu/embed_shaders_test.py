"""Tests of embed_shaders.py: what it refuses and what it writes. Run by ctest, which sets EMBED_SHADERS, GLSLC and
SPIRV_VAL."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

MAIN = "layout(local_size_x = 8) in;\nvoid main() {}\n"


class EmbedShaders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "shaders"
        self.root.mkdir()
        self.write("variants.txt", "")
        self.output = pathlib.Path(folder.name) / "out.cpp"
        self.depfile = pathlib.Path(folder.name) / "out.d"
        self.spirv_val = os.environ["SPIRV_VAL"]

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def write_shader(self, name, text, *sets):
        """Writes an entry point and lists it in variants.txt with these sets of defines."""
        self.write(name, text)
        with open(self.root / "variants.txt", "a", encoding="utf-8") as table:
            table.write("\n    ".join([name, *sets]) + "\n")

    def run_tool(self, *options):
        return subprocess.run(
            [sys.executable, os.environ["EMBED_SHADERS"], "--root", self.root, "--output", self.output, "--depfile",
             self.depfile, "--glslc", os.environ["GLSLC"], "--spirv-val", self.spirv_val, *options],
            capture_output=True, text=True, check=False)

    def assert_refused(self, *words):
        run = self.run_tool()
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        for word in words:
            self.assertIn(word, run.stderr)
        self.assertNotIn("Traceback", run.stderr)
        self.assertFalse(self.output.exists())

    def assert_embedded(self):
        run = self.run_tool()
        self.assertEqual(run.returncode, 0, run.stderr)
        return self.output.read_text(encoding="utf-8")

    def test_takes_what_the_root_lacks_from_the_shared_folder(self):
        shared = self.root.parent / "shared"
        shared.mkdir()
        (shared / "own.glsl").write_text("#error not the file of the root\n", encoding="utf-8")
        (shared / "far.glsl").write_text("float far() { return 1.0; }\n", encoding="utf-8")
        self.write("own.glsl", "float own() { return far(); }\n")
        self.write_shader("a.comp", '#include "far.glsl"\n#include "own.glsl"\n' + MAIN)
        self.assert_refused('no file "far.glsl"')
        run = self.run_tool("--shared", shared, "--function", "otherShaders")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("otherShaders() {", self.output.read_text(encoding="utf-8"))
        self.assertIn(str(shared / "far.glsl"), self.depfile.read_text(encoding="utf-8"))

    def test_refuses_an_include_cycle(self):
        self.write_shader("a.comp", '#include "b.glsl"\n' + MAIN)
        self.write("b.glsl", '#include "c.glsl"\n')
        self.write("c.glsl", '#include "b.glsl"\n')
        self.assert_refused("include cycle: b.glsl -> c.glsl -> b.glsl")

    def test_refuses_a_file_that_includes_itself(self):
        self.write_shader("a.comp", '#include "a.comp"\n' + MAIN)
        self.assert_refused("include cycle: a.comp -> a.comp")

    def test_refuses_a_missing_include_by_file_and_line(self):
        self.write_shader("sub/a.comp", MAIN + '#include "none.glsl"\n')
        self.assert_refused('sub/a.comp:3: no file "none.glsl"')

    def test_refuses_to_leave_the_root(self):
        (self.root.parent / "secret.glsl").write_text("", encoding="utf-8")
        self.write_shader("a.comp", '#include "../secret.glsl"\n' + MAIN)
        self.assert_refused('a.comp:1: no file "../secret.glsl"')

    def test_refuses_a_version_line(self):
        self.write_shader("a.comp", "#version 450\n" + MAIN)
        self.assert_refused("a.comp:1: remove #version")

    def test_includes_each_file_once(self):
        self.write_shader("a.comp", '#include "b.glsl"\n#include "c.glsl"\n' + MAIN)
        self.write("b.glsl", '#include "c.glsl"\nfloat twice(float x) { return 2.0 * once(x); }\n')
        self.write("c.glsl", "float once(float x) { return x; }\n")
        self.assertEqual(self.assert_embedded().count("float once"), 1)

    def test_a_file_included_under_several_conditions_is_included_under_each(self):
        self.write_shader("a.comp", "#if N == 1\n#include \"b.glsl\"\n#endif\n"
                                    "#if N >= 2\n#include \"c.glsl\"\n#include \"b.glsl\"\n#endif\n"
                                    "layout(local_size_x = 1) in;\nvoid main() { float x = once(1.0); }\n", "N=1", "N=2", "N=3")
        self.write("b.glsl", "#ifndef B\n#define B\n#include \"d.h\"\nfloat once(float x) { return x + kTwo; }\n#endif\n")
        self.write("c.glsl", "#if N == 3\n#include \"d.h\"\n#endif\n")
        self.write("d.h", "#pragma once\nconst float kTwo = 2.0;\n")
        self.assert_embedded()

    def test_names_the_line_of_an_included_file_in_a_validation_error(self):
        self.write_shader("a.comp", '\n#include "b.glsl"\n' + MAIN)
        self.write("b.glsl", "// one\n// two\nfloat wrong() { return nothing; }\n")
        self.assert_refused("b.glsl:3: error:", "nothing", "a.comp: not valid with no defines")

    def test_validates_each_variant(self):
        self.write_shader("a.comp", "#if N == 2\n#error two\n#endif\n" + MAIN, "N=1", "N=2")
        self.assert_refused("a.comp:2: error:", "not valid with N=2")

    def test_validates_the_spirv_of_each_variant(self):
        # This replacement of spirv-val refuses the second variant.
        judge = self.root.parent / "spirv-val"
        judge.write_text('#!/bin/sh\nfor module; do :; done\ntest -s "$module" || exit 3\n'
                         'if grep -q second "$module"; then echo "error: line 7: not for OpenGL"; exit 1; fi\n', encoding="utf-8")
        judge.chmod(0o755)
        self.spirv_val = str(judge)
        self.write_shader("a.comp", "layout(local_size_x = 8) in;\nlayout(binding = 0) buffer B { uint N; };\n"
                                    "void main() { N = 1u; }\n", "N=first", "N=second")
        self.assert_refused("a.comp: SPIR-V: error: line 7: not for OpenGL", "a.comp: not valid with N=second")

    def test_says_what_to_install_when_the_validator_is_missing(self):
        self.spirv_val = str(self.root / "no-such-program")
        self.write_shader("a.comp", MAIN)
        self.assert_refused("no-such-program not found: install glslc and spirv-tools")

    def test_plain_uniforms_need_no_location(self):
        self.write_shader("a.comp", "uniform uint n;\nlayout(binding = 0) buffer B { uint b; };\nlayout(local_size_x = 8) in;\nvoid main() { b = n; }\n")
        self.assert_embedded()

    def test_refuses_a_define_without_a_value(self):
        self.write_shader("a.comp", MAIN, "N")
        self.assert_refused("variants.txt:2: a.comp: write NAME=VALUE, the name in capitals, instead of N")

    def test_refuses_a_shader_that_is_not_listed(self):
        self.write("sub/a.comp", MAIN)
        self.assert_refused("sub/a.comp: not listed in variants.txt")

    def test_refuses_a_define_that_the_shader_does_not_use(self):
        self.write("b.glsl", "const int n = N;\n")
        self.write_shader("a.comp", '#include "b.glsl"\n// UNUSED\n/* UNUSED\n */' + MAIN, "N=1", "N=2 UNUSED=1")
        self.assert_refused("variants.txt:3: a.comp does not use UNUSED")

    def test_refuses_a_listed_shader_that_does_not_exist(self):
        self.write_shader("a.comp", MAIN)
        self.write("variants.txt", "# comment\n\na.comp  # comment\nb.comp\n")
        self.assert_refused("variants.txt:4: no shader b.comp")

    def test_refuses_a_shader_that_is_listed_twice(self):
        self.write_shader("a.comp", MAIN)
        self.write_shader("a.comp", MAIN)
        self.assert_refused("variants.txt:2: a.comp is listed a second time")

    def test_refuses_defines_before_the_first_shader(self):
        self.write("variants.txt", "  N=1\n")
        self.write_shader("a.comp", MAIN)
        self.assert_refused("variants.txt:1: defines before the first shader")

    def test_refuses_a_folder_without_the_table(self):
        self.write_shader("a.comp", MAIN)
        (self.root / "variants.txt").unlink()
        self.assert_refused("variants.txt: missing")

    def test_leaves_out_lines_for_cpp_only(self):
        self.write_shader("a.comp", '#include "shared/s.h"\n' + MAIN)
        self.write("shared/s.h", "#pragma once\n#ifdef __cplusplus\n#include <cstdint>\n#else\nfloat f;\n#endif\n")
        text = self.assert_embedded()
        self.assertNotIn("cstdint", text)
        self.assertNotIn("pragma", text)
        self.assertIn("float f;", text)

    def test_refuses_an_angle_include_that_is_not_for_cpp_only(self):
        self.write_shader("a.comp", "#include <shared/s.h>\n" + MAIN)
        self.assert_refused('a.comp:1: write #include "file"')

    def test_maps_lines_back_to_their_files(self):
        self.write_shader("a.comp", '// head\n#include "b.glsl"\n' + MAIN)
        self.write("b.glsl", "float f;\nfloat g;\n")
        text = self.assert_embedded()
        for line in ('LineRange{1, "a.comp", 1}', 'LineRange{2, "b.glsl", 1}', 'LineRange{4, "a.comp", 3}'):
            self.assertIn(line, text)

    def test_names_what_defines_can_set_and_changes_the_digest_with_the_text(self):
        self.write_shader("a.comp", '// COMMENT\n#include "b.glsl"\n' + MAIN, "WIDTH=1")
        self.write("b.glsl", "#ifdef SECOND_ORDER\n#endif\nconst int width = WIDTH;\n")
        text = self.assert_embedded()
        names = re.search(r"kNames0 = \{\n(.*?)\}", text, re.DOTALL).group(1)
        self.assertEqual(re.findall(r'"(\w+)"', names), ["SECOND_ORDER", "WIDTH"])
        digest = re.search(r'kNames0, "([0-9a-f]{64})"', text).group(1)
        self.write("b.glsl", "const int width = WIDTH + 1;\n")
        self.assertNotIn(digest, self.assert_embedded())

    def test_lists_every_file_it_read_for_the_build(self):
        self.write_shader("a.comp", '#include "b.glsl"\n' + MAIN)
        self.write("b.glsl", "")
        self.assert_embedded()
        listed = self.depfile.read_text(encoding="utf-8")
        self.assertTrue(listed.startswith(str(self.output) + ":"))
        for name in ("a.comp", "b.glsl", "variants.txt"):
            self.assertIn(str(self.root.resolve() / name), listed)

    def test_escapes_spaces_in_the_list_of_files(self):
        folder = self.root.parent / "a folder"
        folder.mkdir()
        self.root = self.root.rename(folder / "shaders")
        self.output, self.depfile = folder / "out.cpp", folder / "out.d"
        self.write_shader("a.comp", MAIN)
        self.assert_embedded()
        target, listed = self.depfile.read_text(encoding="utf-8").rstrip("\n").split(": ")
        self.assertEqual(target, str(self.output).replace(" ", "\\ "))
        files = [str(self.root.resolve() / name).replace(" ", "\\ ") for name in ("a.comp", "variants.txt")]
        self.assertEqual(listed, " ".join(files))


if __name__ == "__main__":
    unittest.main()
