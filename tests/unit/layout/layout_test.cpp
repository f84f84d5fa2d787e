// The project keeps to its own layout, and the checker would notice if it did not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>

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
  [[nodiscard]] const fs::path& root() const { return root_; }
  [[nodiscard]] std::string violations() const { return text_of(source_violations(root_)); }

 private:
  fs::path root_;
};

TEST(Layout, FoldersDependOnlyOnWhatTheyMay) { EXPECT_EQ(text_of(source_violations(CONSTRICTOR_ROOT)), ""); }

TEST(Layout, FilesAreShort) { EXPECT_EQ(text_of(long_files(CONSTRICTOR_ROOT)), ""); }

/// Every library of the build, with its symbols.
const std::vector<Library>& libraries() {
  static const std::vector<Library> all = [] {
    std::vector<Library> list = declared_libraries(CONSTRICTOR_ROOT);
    for (auto& library : list) {
      const std::string file = (fs::path(CONSTRICTOR_BUILD) / library.folder / library.name).string();
      const std::unique_ptr<FILE, int (*)(FILE*)> nm(::popen(("nm '" + file + "'").c_str(), "r"), ::pclose);
      char buffer[4096];
      while (const std::size_t count = nm ? std::fread(buffer, 1, sizeof(buffer), nm.get()) : 0) library.nm.append(buffer, count);
      EXPECT_FALSE(library.nm.empty()) << file;
    }
    return list;
  }();
  return all;
}

const Library& library(const std::string& name) {
  const auto found = std::find_if(libraries().begin(), libraries().end(), [&](const auto& one) { return one.name == name; });
  if (found == libraries().end()) throw std::runtime_error("no " + name);
  return *found;
}

TEST(Layout, EveryLibraryIsLookedAt) {
  std::set<std::string> folders;
  for (const auto& one : libraries()) folders.insert(one.folder);
  for (const char* folder : {"components/cli", "components/configuration", "components/control", "components/guidance", "components/input",
                             "components/navigation", "components/perception", "components/planner", "components/robot",
                             "components/ros_bridge", "components/runtime", "sim/camera", "sim/physics", "sim/render", "sim/report",
                             "sim/scenario", "sim/world"}) {
    EXPECT_TRUE(folders.contains(folder)) << folder;
  }
  EXPECT_GE(libraries().size(), 21u);
}

TEST(Layout, LibrariesOfComponentLogicNeedNeitherDdsNorClock) {
  for (const auto& one : libraries()) EXPECT_EQ(text_of(symbol_violations(one)), "");
}

TEST(Layout, LibrariesLinkOnlyWhatTheyMay) { EXPECT_EQ(text_of(link_violations(libraries())), ""); }

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
  EXPECT_EQ(symbol_violations({"components/control", "libconstrictor_control.a", nm}).size(), 3u);
  EXPECT_TRUE(symbol_violations({"components/runtime", "libconstrictor_runtime.a", nm}).empty());
}

TEST(LayoutChecker, FindsALibraryThatNeedsAnotherComponentOrTheSimulation) {
  const Library navigation{"components/navigation", "libconstrictor_navigation.a",
                           "\nsteering.cpp.o:\n0000000000000040 T _ZN11constrictor5steerEd\n0000000000000000 W _ZN11constrictor6sharedEv\n"};
  const Library world{"sim/world", "libconstrictor_world.a", "\nworld.cpp.o:\n0000000000000010 D _ZN11constrictor7gravityE\n"};
  const Library robot{"components/robot", "libconstrictor_robot.a", "\nrobot.cpp.o:\n0000000000000000 T _ZN11constrictor5robotEv\n"};
  const Library api{"components/runtime", "libconstrictor_component_api.a", "\nsetup.cpp.o:\n0000000000000000 T _ZN11constrictor5setupEv\n"};
  const Library host{"components/runtime", "libconstrictor_runtime.a", "\nhost.cpp.o:\n0000000000000000 T _ZN11constrictor4hostEv\n"};
  const Library control{"components/control", "libconstrictor_control.a",
                        "\ncontrol.cpp.o:\n                 U _ZN11constrictor5steerEd\n                 U _ZN11constrictor7gravityE\n"
                        "                 U _ZN11constrictor5robotEv\n                 U _ZN11constrictor5setupEv\n"
                        "                 U _ZN11constrictor4hostEv\n                 U _ZN11constrictor6sharedEv\n"
                        "                 U sin@GLIBC_2.29\n\nlaw.cpp.o:\n0000000000000000 W _ZN11constrictor6sharedEv\n"};
  EXPECT_EQ(text_of(link_violations({navigation, world, robot, api, host, control})),
            "components/control/libconstrictor_control.a needs _ZN11constrictor4hostEv of components/runtime/libconstrictor_runtime.a\n"
            "components/control/libconstrictor_control.a needs _ZN11constrictor5steerEd of components/navigation/libconstrictor_navigation.a\n"
            "components/control/libconstrictor_control.a needs _ZN11constrictor7gravityE of sim/world/libconstrictor_world.a\n");
}

// Real libraries under another flag: what is allowed to the simulation is not to a component, nor between components.
TEST(LayoutChecker, FindsWhatRealLibrariesNeedOfEachOther) {
  Library physics = library("libconstrictor_physics.a");
  const Library& world = library("libconstrictor_world.a");
  EXPECT_EQ(text_of(link_violations({physics, world})), "");
  physics.folder = "components/physics";
  EXPECT_FALSE(link_violations({physics, world}).empty());
  Library logic = library("libconstrictor_guidance_logic.a");
  const Library& guidance = library("libconstrictor_guidance.a");
  EXPECT_EQ(text_of(link_violations({guidance, logic})), "");
  logic.folder = "components/navigation";
  EXPECT_FALSE(link_violations({guidance, logic}).empty());
}

TEST(LayoutChecker, FindsLongFiles) {
  const Tree tree;
  const auto lines = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "int x;\n";
    return text;
  };
  tree.add("components/control/a.cpp", lines(400));
  tree.add("components/control/b.hpp", lines(401));
  tree.add("tests/unit/c.cpp", lines(500));
  tree.add("tests/unit/d.cpp", lines(501));
  tree.add("sim/world/e.yaml", lines(900));
  EXPECT_EQ(text_of(long_files(tree.root())), "components/control/b.hpp: 401 lines, at most 400\ntests/unit/d.cpp: 501 lines, at most 500\n");
}

}  // namespace
}  // namespace constrictor::test
