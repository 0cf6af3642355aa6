"""Makes the wheel: the package with libstormcellar.so.0 and every library that it needs beyond those of every Linux.

`pip wheel python/` builds the library in build/wheel. If $STORMCELLAR_LIBRARY names a built library, this one is taken.
"""

import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # before setuptools 70
    from wheel.bdist_wheel import bdist_wheel

SOURCE = pathlib.Path(__file__).resolve().parent.parent
WORK = SOURCE / "build" / "wheel"
NAME = "libstormcellar.so.0"

FONTS = pathlib.Path("/usr/share/fonts/truetype/dejavu")  # of Debian's package fonts-dejavu-core, for pictures

# Libraries that every Linux with a C++ compiler's runtime has. A wheel with its own copies would clash with them.
OF_THE_SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|util|gcc_s|stdc\+\+))\.so\.\d+")

# The first glibc that was published after a version of libstdc++, both by their last number (2.N and 3.4.N).
GLIBC_OF_GLIBCXX = {29: 34, 30: 35, 33: 39}


def run(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def built_library():
    """Returns the path of the library, and builds it if the environment names no library."""
    named = os.environ.get("STORMCELLAR_LIBRARY")
    if named:
        return pathlib.Path(named).resolve()
    if not (SOURCE / "capi").is_dir():
        raise SystemExit("stormcellar: the library is built from a checkout, as in `pip wheel CHECKOUT/python`")
    subprocess.run(["cmake", "-S", SOURCE, "-B", WORK, "-DCMAKE_BUILD_TYPE=Release", "-DSTORMCELLAR_TESTS=OFF",
                    "-DSTORMCELLAR_BENCH=OFF"], check=True)
    subprocess.run(["cmake", "--build", WORK, "--target", "stormcellar_shared", "--parallel", str(os.cpu_count() or 1)],
                   check=True)
    return (WORK / "capi" / NAME).resolve()


def carry(library, package):
    """Copies the library into the package, and the libraries that it needs into the package's folder libs.

    A copied library has a hash in its name, so that no other module of the process finds or replaces it.
    """
    needed = {name: pathlib.Path(path) for name, path in re.findall(r"(\S+) => (/\S+)", run("ldd", library))
              if not OF_THE_SYSTEM.fullmatch(name)}
    folder = package / "libs"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    names = {name: re.sub(r"\.so", f"-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so", name, count=1)
             for name, path in needed.items()}
    copies = {package / NAME: (library, "$ORIGIN/libs")}
    copies.update({folder / names[name]: (path, "$ORIGIN") for name, path in needed.items()})
    for copy, (original, search) in copies.items():
        shutil.copyfile(original, copy)
        copy.chmod(0o755)
        run("strip", "--strip-unneeded", copy)
        wanted = run("patchelf", "--print-needed", copy).split()
        changes = [word for name in wanted if name in names for word in ("--replace-needed", name, names[name])]
        # One call for both would leave out some of the changes (patchelf 0.14).
        for change in (changes, ["--set-soname", copy.name], ["--set-rpath", search]):
            run("patchelf", *change, copy)
    copy_licenses(needed.values(), folder)
    return list(copies)


def carry_fonts(package):
    """Copies the font of pictures into the folder fonts, where the library looks if the machine has none."""
    folder = package / "fonts"
    folder.mkdir(exist_ok=True)
    fonts = [FONTS / "DejaVuSans.ttf", FONTS / "DejaVuSans-Bold.ttf"]
    for font in fonts:
        shutil.copyfile(font, folder / font.name)
    copy_licenses(fonts, folder)


def copy_licenses(files, folder):
    """Copies the copyright files of the Debian packages that have the files, because their licenses ask for this."""
    if not shutil.which("dpkg"):
        return
    for file in {path.resolve() for path in files}:
        found = subprocess.run(["dpkg", "-S", f"*/{file.name}"], stdout=subprocess.PIPE, text=True).stdout
        owned = [line.split(": ", 1) for line in found.splitlines() if ": /" in line]
        # Packages may name /lib where the file is in /usr/lib.
        for package in {owner.split(":")[0] for owner, path in owned if str(file).endswith(path)}:
            terms = pathlib.Path("/usr/share/doc") / package / "copyright"
            if terms.is_file():
                shutil.copyfile(terms, folder / f"{package}.copyright")


def glibc_minor(libraries):
    """Returns N of glibc 2.N, the oldest glibc of the systems on which the libraries run."""
    symbols = "".join(run("objdump", "-T", path) for path in libraries)
    minors = [int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", symbols)]
    newest = max([int(minor) for minor in re.findall(r"GLIBCXX_3\.4\.(\d+)", symbols)], default=0)
    own = int(platform.libc_ver()[1].split(".")[1])
    minors.append(min((glibc for cxx, glibc in GLIBC_OF_GLIBCXX.items() if cxx >= newest), default=own))
    if "GLIBC_ABI_DT_RELR" in symbols:
        minors.append(36)
    return max(minors)


class Build(build_py):
    def run(self):
        shutil.rmtree(self.build_lib, ignore_errors=True)  # else removed modules stay in the wheel
        super().run()
        package = pathlib.Path(self.build_lib) / "stormcellar"
        carry_fonts(package)
        self.distribution.glibc_minor = glibc_minor(carry(built_library(), package))


class Package(Distribution):
    def has_ext_modules(self):
        """Returns True, because the package has binary libraries, so its wheel is only for this kind of processor."""
        return True


class Wheel(bdist_wheel):
    """Tags the wheel with any Python 3, and with the systems on which its libraries run."""

    def get_tag(self):
        minor = getattr(self.distribution, "glibc_minor", None)
        return "py3", "none", f"manylinux_2_{minor}_{platform.machine()}" if minor else "any"


WORK.mkdir(parents=True, exist_ok=True)
setup(version=re.search(r"^project\(stormcellar VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(), re.M)[1],
      distclass=Package, cmdclass={"build_py": Build, "bdist_wheel": Wheel},
      options={"build": {"build_base": str(WORK / "python")}, "egg_info": {"egg_base": str(WORK)}})
