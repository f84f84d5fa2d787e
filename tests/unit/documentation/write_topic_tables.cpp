// write_topic_tables README.md: writes the tables of topics in idl/README.md again.
#include <fmt/format.h>

#include <fstream>
#include <iostream>

#include "topic_tables.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_topic_tables README.md\n";
    return 64;
  }
  try {
    std::ifstream before(argv[1]);
    const std::string text{std::istreambuf_iterator<char>(before), {}};
    const std::string made = constrictor::documentation::with_topic_tables(text);
    std::ofstream file(argv[1]);
    file << made;
    if (!file.flush()) throw std::runtime_error("cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::cerr << argv[1] << ": " << error.what() << "\n";
    return 1;
  }
}
