"""Builds what the package takes from the project: the messages of proto/ by protoc, and the codec's decoder by the C++ compiler.

Both come from the checkout around this folder, so that the client cannot differ from the server. PROTOC and CXX name other programs.
"""
import os
import pathlib
import re
import subprocess

import setuptools
from setuptools.command.build_py import build_py

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
SERVER = PROJECT / "server"
MESSAGES = ("options", "scene", "wire", "api")


def version():
    found = re.search(r"^project\(spindrift VERSION (\d+\.\d+\.\d+) ", (PROJECT / "CMakeLists.txt").read_text(), re.MULTILINE)
    if not found:
        raise SystemExit(f"{PROJECT / 'CMakeLists.txt'} has no version: install this package from a checkout of Spindrift")
    return found[1]


def run(command, what):
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"{what}: {error}") from error


class BuildWithProject(build_py):
    """Adds spindrift/v1/*_pb2.py and spindrift/libspindrift_decoder.so."""

    def run(self):
        super().run()
        package = pathlib.Path(self.build_lib) / "spindrift"
        protos = [f"spindrift/v1/{name}.proto" for name in MESSAGES]
        run([os.environ.get("PROTOC", "protoc"), f"--proto_path={PROJECT / 'proto'}", f"--python_out={self.build_lib}", *protos],
            "the messages need protoc (Debian: protobuf-compiler)")
        (package / "v1" / "__init__.py").write_text("")
        bitstream = SERVER / "bitstream"
        sources = [*sorted((bitstream / "decode").glob("*.cpp")), bitstream / "c" / "spindrift_decoder.cpp", SERVER / "core" / "crc32c_tables.cpp"]
        folders = [bitstream, bitstream / "include", SERVER / "core" / "include"]
        run([os.environ.get("CXX", "g++"), "-std=c++20", "-O3", "-DNDEBUG", "-fPIC", "-shared", "-fvisibility=hidden",
             *(f"-I{folder}" for folder in folders), *map(str, sources), "-o", str(package / "libspindrift_decoder.so")],
            "the decoder needs a compiler of C++20 (Debian: g++)")


setuptools.setup(version=version(), cmdclass={"build_py": BuildWithProject}, has_ext_modules=lambda: True)
