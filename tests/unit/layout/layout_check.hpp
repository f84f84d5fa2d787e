// Rules of the layout that the build cannot enforce. The build itself enforces which folder includes which: each
// library has its own include root (scripts/cmake/Constrictor.cmake).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace constrictor::testing {

/// The files below the folders `tops` of `root` with one of these extensions (".hpp"), in order.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& root, const std::vector<std::string>& tops,
                                               const std::vector<std::string>& extensions);

/// Every violation in the source tree `root`, as "components/x/y.cpp:12: why": Cyclone's headers outside the libraries
/// that call it, includes by relative path, names of ground truth in code that runs on a robot.
std::vector<std::string> source_violations(const std::filesystem::path& root);

/// Every opened namespace that is not `constrictor`, the namespace of a folder in which the file is, or one of the
/// exceptions in CONTRIBUTING.md (Names), as "file:12: opens namespace NAME". The folder examples/ is left out, because
/// its projects are users of this one.
std::vector<std::string> namespace_violations(const std::filesystem::path& root);

/// C++, IDL, Python, JavaScript, shell and CMake files of more than 300 lines, unless the README of their folder, or of
/// the nearest folder above that has one, says "`NAME` is longer than 300 lines because" and the reason.
std::vector<std::string> long_files(const std::filesystem::path& root);

/// Lines of more than 120 columns in C++, IDL, CMake, YAML and shell files, and in README files, as "file:12: 130
/// columns". In README files, rows of tables and single words, for example links, may be longer because they cannot be
/// wrapped.
std::vector<std::string> long_lines(const std::filesystem::path& root);

/// Links of Markdown files to files of the project that do not exist, and to headings that the file does not have, as
/// "file:12: target".
std::vector<std::string> broken_links(const std::filesystem::path& root);

/// A static library of the project.
struct Library {
  std::string folder;  ///< "components/control", "sim/world", "idl"
  std::string name;    ///< "libconstrictor_control.a"
  std::string nm;      ///< output of `nm`
};

/// The libraries that the CMakeLists.txt files of idl/, components/ and sim/ declare; `nm` is left empty.
std::vector<Library> declared_libraries(const std::filesystem::path& root);

/// Every function of DDS, of clocks and of unseeded random numbers that the library calls although it must not.
std::vector<std::string> symbol_violations(const Library& library);

}  // namespace constrictor::testing
