#!/usr/bin/env python3
"""Writes which third-party software a bundle or an image contains, with versions and licences, as CycloneDX 1.5 JSON.

  sbom.py bundle --version X --build-dir build/release --web-client web-client --licences FOLDER FILE... > sbom.cdx.json
      FILEs are the libraries that were copied into the bundle. Also listed are the Debian packages whose headers are compiled into
      the program (from ninja's list of dependencies) or into the page's WebAssembly, and the npm packages of the page. Copies the
      text of every licence to FOLDER.
  sbom.py image --root FOLDER > sbom.cdx.json
      FOLDER is the root of an image's file system, with a bundle in opt/spindrift: every Debian package that is installed there,
      and what the bundle's own list names.
  sbom.py table FILE
      prints the list of such a file: name, version, licences.

Licences of Debian packages are those of their copyright files: the licence fields where the file has the machine-readable form
(DEP-5; paragraphs about debian/ itself do not count), otherwise the common licences that the text refers to.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

# Short names of DEP-5 whose SPDX identifier has another form. "-only" and "-or-later" are added by spdx_id.
SPDX_NAMES = {
    "Expat": "MIT", "expat": "MIT", "MIT": "MIT", "MIT/X11": "MIT", "X11": "X11", "Apache-2": "Apache-2.0", "Apache-2.0": "Apache-2.0", "Artistic": "Artistic-1.0-Perl",
    "BSD-2-clause": "BSD-2-Clause", "BSD-2-Clause": "BSD-2-Clause", "BSD-3-clause": "BSD-3-Clause", "BSD-3-Clause": "BSD-3-Clause",
    "BSD-4-clause": "BSD-4-Clause", "BSL-1.0": "BSL-1.0", "BSL-1": "BSL-1.0", "Boost-1.0": "BSL-1.0", "ISC": "ISC", "Zlib": "Zlib",
    "zlib": "Zlib", "Libpng": "Libpng", "libpng": "Libpng", "CC0-1.0": "CC0-1.0", "NCSA": "NCSA", "OpenSSL": "OpenSSL", "PSF-2": "PSF-2.0",
    "SGI-B-2.0": "SGI-B-2.0", "MPL-2.0": "MPL-2.0", "bzip2-1.0.6": "bzip2-1.0.6", "curl": "curl", "Unicode": "Unicode-DFS-2015",
}
GNU = re.compile(r"^(A?GPL|LGPL|GFDL)-?v?(\d)(?:\.(\d))?(\+)?(?:-only|-or-later)?$")
# Pattern of the package whose headers are compiled into the page's WebAssembly, which ninja does not build.
PAGE_HEADERS = "libc++-*-dev-wasm32"
# The loader of OpenGL is code that this package generates.
GENERATED_BY = ["python3-glad"]


def spdx_id(short_name):
    """Returns the SPDX identifier of a licence's short name, or None if the licence is not in its list."""
    gnu = GNU.match(short_name)
    if gnu:
        family, major, minor, later = gnu.groups()
        later = later or short_name.endswith("-or-later")
        return f"{family}-{major}.{minor or 0}-{'or-later' if later else 'only'}"
    # "BSD-3-Clause~Google" is Debian's name for a text with its own holder of copyright.
    return SPDX_NAMES.get(short_name.split("~")[0])


def short_names(copyright_text):
    """Returns the licences that a Debian copyright file names, in order, each once."""
    names = {}
    if re.match(r"Format(-Specification)?:", copyright_text, re.I):
        for paragraph in re.split(r"\n\s*\n", copyright_text):
            files = re.search(r"^Files:\s*(.*(?:\n\s.*)*)", paragraph, re.M)
            field = re.search(r"^License:[ \t]*(\S.*)$", paragraph, re.M)
            if not files or not field or all(name.startswith("debian/") for name in files.group(1).split()):
                continue
            for name in re.split(r"\s+and/or\s+|\s+and\s+|\s+or\s+|,\s*|\s*\|\s*", field.group(1), flags=re.I):
                name = re.sub(r"\s+with\s+.*", lambda match: match.group(0).rstrip(".,"), name.strip(" ,()"))
                if name:
                    names[name] = True
    for name in re.findall(r"/usr/share/common-licenses/([A-Za-z0-9.+-]*[A-Za-z0-9])", copyright_text) if not names else []:
        names[name] = True
    return list(names)


def licences(copyright_text):
    # The text of GCC's packages is not machine-readable; the exception is what allows the program another licence.
    if "GCC Runtime Library Exception" in copyright_text:
        return [{"license": {"name": "GPL-3.0-or-later WITH GCC-exception-3.1"}}]
    out = [{"license": {"id": spdx} if (spdx := spdx_id(name)) else {"name": name}} for name in short_names(copyright_text)]
    unlike = {json.dumps(entry, sort_keys=True): entry for entry in out}
    return list(unlike.values()) or [{"license": {"name": "see the package's copyright file"}}]


def debian_component(name, version, architecture, copyright_text, use):
    return {
        "type": "library", "bom-ref": f"deb:{name}", "name": name, "version": version, "licenses": licences(copyright_text),
        "purl": f"pkg:deb/debian/{name.replace('+', '%2B')}@{version.replace('+', '%2B').replace(':', '%3A')}?arch={architecture}&distro=bookworm",
        "properties": [{"name": "spindrift:use", "value": use}],
    }


def copyright_path(root, package):
    path = root / "usr/share/doc" / package / "copyright"
    if not path.is_file():
        sys.exit(f"sbom: {path} is missing, so the licence of {package} is unknown")
    return path


def installed_names(pattern):
    """Returns the names of the installed packages that match the pattern, at least one."""
    lines = subprocess.run(
        ["dpkg-query", "--show", "--showformat=${Package} ${db:Status-Status}\n", pattern], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    return [line.split()[0] for line in lines if line.endswith(" installed")]


def installed_package(package, use, licence_folder):
    """Returns the component of a package of this machine, and copies its copyright file."""
    version, architecture = subprocess.run(
        ["dpkg-query", "--show", "--showformat=${Version} ${Architecture}\n", package], check=True, capture_output=True, text=True
    ).stdout.splitlines()[0].split()
    path = copyright_path(Path("/"), package)
    shutil.copyfile(path, licence_folder / f"{package}.txt")
    return debian_component(package, version, architecture, path.read_text(errors="replace"), use)


def owners(paths):
    """Returns the names of the Debian packages that own the files; a file without an owner is an error."""
    real = sorted({str(Path(path).resolve()) for path in paths})
    # Packages may have registered the file below /lib, which is a link to /usr/lib today.
    names = real + [path.removeprefix("/usr") for path in real]
    lines = subprocess.run(["dpkg-query", "--search", *names], capture_output=True, text=True).stdout.splitlines()
    owner_of = {path: package.split(",")[0].split(":")[0] for package, _, path in (line.rpartition(": ") for line in lines)}
    for path in real:
        if path not in owner_of and path.removeprefix("/usr") not in owner_of:
            sys.exit(f"sbom: no Debian package owns {path}, so its licence is unknown")
    return set(owner_of.values())


def system_headers(build_folder):
    """Returns the system's headers with which objects of the program, not those of its tests, were compiled."""
    text = subprocess.run(["ninja", "-C", str(build_folder), "-t", "deps"], check=True, capture_output=True, text=True).stdout
    headers, of_a_test = set(), False
    for line in text.splitlines():
        if line and not line.startswith(" "):
            of_a_test = line.startswith("tests/")
        elif not of_a_test and line.strip().startswith(("/usr/include/", "/usr/lib/", "/usr/share/")):
            headers.add(line.strip())
    if not headers:
        sys.exit(f"sbom: ninja lists no headers for {build_folder}; build the program first")
    return headers


def npm_components(web_client, licence_folder):
    """Returns the packages that the page's bundle may contain: the dependencies, and theirs."""
    out, waiting, seen = [], list(json.loads((web_client / "package.json").read_text())["dependencies"]), set()
    while waiting:
        name = waiting.pop(0)
        if name in seen:
            continue
        seen.add(name)
        folder = web_client / "node_modules" / name
        package = json.loads((folder / "package.json").read_text())
        waiting += package.get("dependencies", {})
        out.append({
            "type": "library", "bom-ref": f"npm:{name}", "name": name, "version": package["version"], "licenses": [{"expression": package["license"]}],
            "purl": f"pkg:npm/{name.replace('@', '%40')}@{package['version']}", "properties": [{"name": "spindrift:use", "value": "in the page"}],
        })
        texts = sorted(path for path in folder.iterdir() if re.match(r"(licen[cs]e|copying)", path.name, re.I))
        # Apache's licence is often only named in package.json.
        if not texts and "Apache-2.0" in package["license"]:
            texts = [Path("/usr/share/common-licenses/Apache-2.0")]
        if not texts:
            sys.exit(f"sbom: {folder} has no text of its licence {package['license']}")
        shutil.copyfile(texts[0], licence_folder / f"{name.removeprefix('@').replace('/', '-')}.txt")
    return out


def document(version, components):
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {"component": {"type": "application", "bom-ref": "spindrift", "name": "spindrift", "version": version,
                                   "licenses": [{"license": {"id": "MIT"}}]}},
        "components": sorted(components, key=lambda component: component["bom-ref"]),
    }


def bundle(options):
    folder = Path(options.licences)
    folder.mkdir(parents=True, exist_ok=True)
    linked = owners(options.files)
    compiled = (owners(system_headers(options.build_dir)) | set(installed_names(PAGE_HEADERS)) | set(GENERATED_BY)) - linked
    components = [installed_package(name, "shared library in the bundle", folder) for name in linked]
    components += [installed_package(name, "headers or generated code, compiled in", folder) for name in compiled]
    return document(options.version, components + npm_components(Path(options.web_client), folder))


def image(options):
    root = Path(options.root)
    own = json.loads((root / "opt/spindrift/share/sbom.cdx.json").read_text())
    # The bundle's copies of libraries come from the build stage and are files of their own.
    for component in own["components"]:
        component["bom-ref"] = "bundle/" + component["bom-ref"]
    components = own["components"]
    for paragraph in (root / "var/lib/dpkg/status").read_text().split("\n\n"):
        fields = dict(re.findall(r"^([A-Za-z-]+): (.*)$", paragraph, re.M))
        if not fields.get("Status", "").endswith(" installed"):
            continue
        path = copyright_path(root, fields["Package"])
        # The copyright file of some packages is a link to that of another package, as an absolute path inside the image.
        text = (root / str(path.resolve()).lstrip("/")).read_text(errors="replace") if path.is_symlink() and not path.exists() else path.read_text(errors="replace")
        components.append(debian_component(fields["Package"], fields["Version"], fields["Architecture"], text, "installed in the image"))
    return document(own["metadata"]["component"]["version"], components)


def table(options):
    content = json.loads(Path(options.file).read_text())
    for component in [content["metadata"]["component"], *content["components"]]:
        names = [entry.get("expression") or entry["license"].get("id") or entry["license"]["name"] for entry in component["licenses"]]
        print(f"{component['name']:<32} {component['version']:<32} {', '.join(names)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    of_bundle = commands.add_parser("bundle")
    for name in ("version", "build-dir", "web-client", "licences"):
        of_bundle.add_argument(f"--{name}", required=True)
    of_bundle.add_argument("files", nargs="+")
    commands.add_parser("image").add_argument("--root", required=True)
    commands.add_parser("table").add_argument("file")
    options = parser.parse_args()
    if options.command == "table":
        table(options)
    else:
        json.dump(bundle(options) if options.command == "bundle" else image(options), sys.stdout, indent=1)
        print()


if __name__ == "__main__":
    main()
