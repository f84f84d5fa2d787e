// write_parameter_tables SOURCE_TREE: writes the YAML files of all components, and the tables in their READMEs, from
// the rows of their parameters. The build target `parameter_tables` calls it.
#include <cstdio>
#include <exception>
#include <fstream>

#include "parameter_tables.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_parameter_tables SOURCE_TREE\n");
    return 64;
  }
  int status = 0;
  try {
    for (const auto& file : constrictor::derived_files(argv[1])) {
      if (!file.error.empty()) {
        std::fprintf(stderr, "%s\n", file.error.c_str());
        status = 1;
      } else if (constrictor::content_of(file.path) != file.text) {
        std::ofstream(file.path, std::ios::binary) << file.text;
        std::printf("%s: written\n", file.path.c_str());
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_parameter_tables: %s\n", error.what());
    status = 1;
  }
  return status;
}
