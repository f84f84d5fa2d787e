// The allowed dependencies between folders, checked by #include lines, by names of ground truth, and by linker symbols; and file sizes.
//
//   idl <- runtime <- mains        robot, configuration <- component logic <- mains
//   Component logic sees ports, topics and messages only: no DDS, no clock, no simulation, no other component.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace constrictor::test {

/// Every violation in the source tree `root`, as "components/x/y.cpp:12: why".
std::vector<std::string> source_violations(const std::filesystem::path& root);

/// Source files that are too long to be read with ease: more than 400 lines, of tests 500.
std::vector<std::string> long_files(const std::filesystem::path& root);

/// A static library of the project.
struct Library {
  std::string folder;  ///< "components/control", "sim/world", "idl"
  std::string name;    ///< "libconstrictor_control.a"
  std::string nm;      ///< output of `nm`
};

/// The libraries that the CMakeLists.txt of idl/ and of the folders of components/ and sim/ declare; `nm` is left empty.
std::vector<Library> declared_libraries(const std::filesystem::path& root);

/// Every function that the library needs and must not: of DDS, of clocks, of unseeded random numbers.
std::vector<std::string> symbol_violations(const Library& library);

/// Every library that needs what another one defines in a folder that it must not know.
std::vector<std::string> link_violations(const std::vector<Library>& libraries);

}  // namespace constrictor::test
