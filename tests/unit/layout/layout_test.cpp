// The project keeps to its own layout, and the checker would notice if it did not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>

#include "layout_check.hpp"

namespace constrictor::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

/// A made-up source tree, removed at the end.
class Tree {
 public:
  Tree() : root_(fs::temp_directory_path() / ("constrictor_layout_" + std::to_string(::getpid()))) {}
  ~Tree() { fs::remove_all(root_); }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  void add(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  [[nodiscard]] std::string violations() const { return text_of(source_violations(root_)); }

 private:
  fs::path root_;
};

TEST(Layout, FoldersDependOnlyOnWhatTheyMay) { EXPECT_EQ(text_of(source_violations(CONSTRICTOR_ROOT)), ""); }

TEST(Layout, LibrariesOfComponentLogicNeedNeitherDdsNorClock) {
  int libraries = 0;
  for (const char* folder : {"components", "sim"}) {
    if (!fs::exists(fs::path(CONSTRICTOR_BUILD) / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CONSTRICTOR_BUILD) / folder)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("libconstrictor_", 0) != 0 || entry.path().extension() != ".a") continue;
      const std::unique_ptr<FILE, int (*)(FILE*)> nm(::popen(("nm -u '" + entry.path().string() + "'").c_str(), "r"), ::pclose);
      ASSERT_TRUE(nm);
      std::string output;
      char buffer[4096];
      while (const std::size_t count = std::fread(buffer, 1, sizeof(buffer), nm.get())) output.append(buffer, count);
      ASSERT_FALSE(output.empty()) << name;
      EXPECT_EQ(text_of(symbol_violations(name, output)), "");
      ++libraries;
    }
  }
  EXPECT_GE(libraries, 1);
}

TEST(LayoutChecker, AcceptsAGoodTree) {
  const Tree tree;
  tree.add("components/control/control.cpp",
           "#include \"control/control.hpp\"\n#include \"robot/limits.hpp\"\n#include \"runtime/ports.hpp\"\n#include <vector>\n"
           "// WorldState is not for us\n");
  tree.add("components/control/main.cpp", "#include \"runtime/component_main.hpp\"\n");
  tree.add("components/runtime/dds/domain.hpp", "#include <dds/dds.h>\n");
  tree.add("sim/physics/physics.cpp", "#include \"sim/world/world.hpp\"\nauto x = topics::kWorldState;\n");
  EXPECT_EQ(tree.violations(), "");
}

TEST(LayoutChecker, FindsEachForbiddenDependency) {
  const Tree tree;
  tree.add("components/control/a.cpp", "#include <dds/dds.h>\n");
  tree.add("components/control/b.cpp", "\n#include \"navigation/navigation.hpp\"\n");
  tree.add("components/control/c.cpp", "#include \"sim/world/world.hpp\"\n");
  tree.add("components/control/d.cpp", "#include \"runtime/host.hpp\"\n");
  tree.add("components/control/e.cpp", "#include \"runtime/component_main.hpp\"\n");
  tree.add("components/control/f.cpp", "auto pose = wiring.latest(topics::kWorldState);\n");
  tree.add("components/control/g.cpp", "open(setup.scenario_file);\n");
  tree.add("components/robot/h.hpp", "#include \"runtime/component.hpp\"\n");
  tree.add("components/runtime/i.cpp", "#include \"robot/robot_model.hpp\"\n");
  tree.add("idl/constrictor/j.cpp", "#include \"runtime/component.hpp\"\n");
  tree.add("sim/camera/k.cpp", "#include \"perception/perception.hpp\"\n");
  EXPECT_EQ(tree.violations(),
            "components/control/a.cpp:1: includes dds/dds.h; only components/runtime may\n"
            "components/control/b.cpp:2: includes navigation/navigation.hpp\n"
            "components/control/c.cpp:1: includes sim/world/world.hpp\n"
            "components/control/d.cpp:1: includes runtime/host.hpp\n"
            "components/control/e.cpp:1: includes runtime/component_main.hpp\n"
            "components/control/f.cpp:1: uses kWorldState, which a robot does not have\n"
            "components/control/g.cpp:1: uses scenario_file, which a robot does not have\n"
            "components/robot/h.hpp:1: includes runtime/component.hpp\n"
            "components/runtime/i.cpp:1: includes robot/robot_model.hpp\n"
            "idl/constrictor/j.cpp:1: includes runtime/component.hpp\n"
            "sim/camera/k.cpp:1: includes perception/perception.hpp\n");
}

TEST(LayoutChecker, FindsForbiddenSymbols) {
  const std::string nm =
      "\ncontrol.cpp.o:\n                 U dds_write\n                 U _ZNSt6chrono3_V212steady_clock3nowEv\n"
      "                 U clock_gettime@GLIBC_2.17\n                 U sin\n                 U constrictor_msg_JointState_desc\n";
  EXPECT_EQ(symbol_violations("libconstrictor_control.a", nm).size(), 3u);
  EXPECT_TRUE(symbol_violations("libconstrictor_runtime.a", nm).empty());
}

}  // namespace
}  // namespace constrictor::test
