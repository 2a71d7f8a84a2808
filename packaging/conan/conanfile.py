# SPDX-License-Identifier: GPL-3.0-or-later
# conan create packaging/conan: the component patterns, as a tool of the build machine (tool_requires).
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class NookConan(ConanFile):
    name = "nook"
    description = "Ambient obscurance assets, made and measured: the component patterns"
    license = "GPL-3.0-or-later"
    package_type = "application"
    settings = "os", "arch", "compiler", "build_type"

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        text = load(self, os.path.join(self._root, "CMakeLists.txt"))
        self.version = re.search(r"project\(nook VERSION ([0-9.]+)", text).group(1)

    def export_sources(self):
        for folder in ("cmake/*", "libsamples/*", "patterns/*", "tools/*", "LICENSES/*", "CMakeLists.txt", "LICENSE", "CHANGELOG.md"):
            copy(self, folder, self._root, self.export_sources_folder)

    def requirements(self):
        for library in ("cgal/5.6.1", "cli11/2.3.2", "eigen/3.4.0", "glm/0.9.9.8", "nlohmann_json/3.11.3"):
            self.requires(library, libs=False, headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for name, value in (("NOOK_COMPONENTS", "patterns"), ("NOOK_BUILD_TESTS", False), ("NOOK_BUILD_BENCHMARKS", False)):
            toolchain.cache_variables[name] = value
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.libdirs = []
        self.cpp_info.includedirs = ["include"]
        self.cpp_info.set_property("cmake_find_mode", "none")  # nook's own package of CMake is found
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "nook")]
