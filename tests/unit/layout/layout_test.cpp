// The project keeps its own rules of layout, and the checker finds every violation of them.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "layout_check.hpp"
#include "source_tree.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

TEST(Layout, FoldersDependOnlyOnWhatTheyMay) { EXPECT_EQ(text_of(source_violations(source_path())), ""); }

TEST(Layout, FilesAreShort) {
  EXPECT_EQ(text_of(long_files(source_path())), "") << "Accepted are 300 lines. Split the file, or write in the README "
                                                       "of its folder: `FILE` is longer than 300 lines "
                                                       "because ...";
}

TEST(Layout, LinesAreShort) { EXPECT_EQ(text_of(long_lines(source_path())), ""); }

TEST(Layout, LinksLeadSomewhere) { EXPECT_EQ(text_of(broken_links(source_path())), ""); }

/// Every library of the build, with its symbols.
std::vector<Library> libraries_with_symbols() {
  std::vector<Library> list = declared_libraries(source_path());
  for (auto& library : list) {
    const std::string file = (build_path() / library.folder / library.name).string();
    const std::unique_ptr<FILE, int (*)(FILE*)> nm(::popen(("nm '" + file + "'").c_str(), "r"), ::pclose);
    char buffer[4096];
    while (const std::size_t count = nm ? std::fread(buffer, 1, sizeof(buffer), nm.get()) : 0)
      library.nm.append(buffer, count);
    EXPECT_FALSE(library.nm.empty()) << file;
  }
  return list;
}

TEST(Layout, TheLibrariesOfAllFoldersAreChecked) {
  std::set<std::string> folders;
  for (const auto& one : declared_libraries(source_path())) folders.insert(one.folder);
  for (const char* folder : {"idl",
                             "components/lib/configuration",
                             "components/lib/dynamixel",
                             "components/lib/robot",
                             "components/lib/plant",
                             "components/lib/serial",
                             "components/lib/video",
                             "components/lib/component",
                             "components/lib/barrier",
                             "components/lib/cyclone",
                             "components/lib/recording",
                             "components/lib/runtime",
                             "components/tools/cli",
                             "components/tools/common",
                             "components/tools/conform",
                             "components/tools/dashboard",
                             "components/tools/ros_bridge",
                             "components/tools/host",
                             "components/tools/pictures",
                             "components/tools/views",
                             "components/control",
                             "components/guidance",
                             "components/input",
                             "components/navigation",
                             "components/perception",
                             "components/planner",
                             "components/plant_relay",
                             "components/servo_bus",
                             "components/video_capture",
                             "sim/camera",
                             "sim/camera_emulator",
                             "sim/emulation",
                             "sim/figure",
                             "sim/overview",
                             "sim/physics",
                             "sim/render",
                             "sim/report",
                             "sim/scenario_loader",
                             "sim/servo_emulator",
                             "sim/world"}) {
    EXPECT_TRUE(folders.contains(folder)) << folder;
  }
}

TEST(Layout, LibrariesOfComponentLogicNeedNeitherDdsNorClock) {
  for (const auto& one : libraries_with_symbols()) EXPECT_EQ(text_of(symbol_violations(one)), "");
}

// The compiler itself rejects an #include of what a folder must not know. The test compiles a file of the folder with
// its own command and one more #include.
class Wall : public ::testing::Test {
 protected:
  /// Whether `file` of the project still compiles when it includes `header` as well.
  static bool compiles(const std::string& file, const std::string& header) {
    std::ifstream stream(build_path() / "compile_commands.json");
    const auto commands = nlohmann::json::parse(stream);
    // The command of the file itself counts, and otherwise that of a group of files: a folder may have several targets.
    const auto by_itself = std::find_if(commands.begin(), commands.end(),
                                        [&](const auto& entry) { return entry["file"] == source_path(file).string(); });
    const auto command = by_itself != commands.end()
                             ? by_itself
                             : std::find_if(commands.begin(), commands.end(),
                                            [&](const auto& entry) { return is_group(entry["file"], file); });
    if (command == commands.end()) throw std::runtime_error("compile_commands.json does not name " + file);
    const std::string text = (*command)["command"];
    const std::string compiler = text.substr(0, text.find(" -o "));
    const Tree tree;
    tree.add("probe.cpp", "#include \"" + header + "\"\n");
    const std::string call = "cd '" + (*command)["directory"].get<std::string>() + "' && " + compiler +
                             " -fsyntax-only -w '" + (tree.root() / "probe.cpp").string() + "' 2>/dev/null";
    return std::system(call.c_str()) == 0;
  }

 private:
  /// Whether this is a group of files of the folder of `file`.
  static bool is_group(const std::string& compiled, const std::string& file) {
    const std::string groups = (build_path(fs::path(file).parent_path()) / "CMakeFiles/").string();
    return compiled.starts_with(groups) && compiled.find("/Unity/") != std::string::npos;
  }
};

/// A source file, and a header that it includes.
using Inclusion = std::pair<const char*, const char*>;

constexpr Inclusion kAllowed[] = {
    {"components/control/control.cpp", "robot/kinematics.hpp"},
    {"components/control/control.cpp", "component/ports.hpp"},
    {"components/control/main.cpp", "runtime/component_main.hpp"},
    {"sim/physics/physics.cpp", "sim/world/world.hpp"},
    {"components/tools/cli/usage.cpp", "cyclone/endpoint.hpp"},
};
constexpr Inclusion kForbidden[] = {
    {"components/control/control.cpp", "navigation/navigation.hpp"},
    {"components/control/control.cpp", "runtime/host.hpp"},
    {"components/control/control.cpp", "cyclone/endpoint.hpp"},
    {"components/control/control.cpp", "barrier/member.hpp"},
    {"components/control/control.cpp", "sim/world/world.hpp"},
    {"components/lib/robot/kinematics.cpp", "component/ports.hpp"},
    {"components/lib/barrier/member.cpp", "cyclone/endpoint.hpp"},
    {"components/lib/runtime/host.cpp", "robot/robot_model.hpp"},
    {"components/tools/cli/usage.cpp", "sim/world/world.hpp"},
    {"components/tools/dashboard/main.cpp", "sim/scenario_loader/scenario.hpp"},
    {"components/tools/dashboard/main.cpp", "cli/usage.hpp"},
    {"components/tools/pictures/main.cpp", "cli/usage.hpp"},
    {"sim/camera/camera.cpp", "perception/perception.hpp"},
    {"sim/camera/camera.cpp", "runtime/host.hpp"},
};

TEST_F(Wall, AFolderCompilesWithWhatItMayInclude) {
  for (const auto& [file, header] : kAllowed) EXPECT_TRUE(compiles(file, header)) << file << " with " << header;
}

TEST_F(Wall, AFolderDoesNotCompileWithWhatItMustNotInclude) {
  for (const auto& [file, header] : kForbidden) EXPECT_FALSE(compiles(file, header)) << file << " with " << header;
}

TEST(LayoutChecker, AcceptsAGoodTree) {
  const Tree tree;
  tree.add("components/control/control.cpp",
           "#include \"control/control.hpp\"\n#include <vector>\n// WorldState is not for us\n");
  tree.add("components/lib/cyclone/domain.hpp", "#include <dds/dds.h>\n");
  tree.add("sim/physics/physics.cpp", "#include \"sim/world/world.hpp\"\nauto x = topics::kWorldState;\n");
  EXPECT_EQ(text_of(source_violations(tree.root())), "");
}

TEST(LayoutChecker, FindsEachForbiddenLine) {
  const Tree tree;
  tree.add("components/control/a.cpp", "#include <dds/dds.h>\n");
  tree.add("components/control/b.cpp", "\n#include \"../navigation/navigation.hpp\"\n");
  tree.add("components/control/c.cpp", "auto pose = wiring.latest(topics::kWorldState);\n");
  tree.add("components/control/d.cpp", "open(setup.scenario_file);\n");
  tree.add("components/tools/cli/e.cpp", "#include <dds/ddsc/dds_public_qos.h>\n");
  tree.add("sim/camera/f.cpp", "#include \"dds/dds.h\"\n");
  EXPECT_EQ(text_of(source_violations(tree.root())),
            "components/control/a.cpp:1: includes dds/dds.h\n"
            "components/control/b.cpp:2: includes ../navigation/navigation.hpp by its place, not by its name\n"
            "components/control/c.cpp:1: uses kWorldState, which a robot does not have\n"
            "components/control/d.cpp:1: uses scenario_file, which a robot does not have\n"
            "components/tools/cli/e.cpp:1: includes dds/ddsc/dds_public_qos.h\n"
            "sim/camera/f.cpp:1: includes dds/dds.h\n");
}

TEST(LayoutChecker, FindsForbiddenSymbols) {
  const std::string nm =
      "\ncontrol.cpp.o:\n                 U dds_write\n                 U _ZNSt6chrono3_V212steady_clock3nowEv\n"
      "                 U clock_gettime@GLIBC_2.17\n                 U sin\n                 U "
      "constrictor_msg_JointState_desc\n";
  EXPECT_EQ(symbol_violations({"components/control", "libconstrictor_control.a", nm}).size(), 3u);
  EXPECT_TRUE(symbol_violations({"components/lib/runtime", "libconstrictor_runtime.a", nm}).empty());
}

TEST(LayoutChecker, FindsLongFilesWithoutAReason) {
  const Tree tree;
  const auto lines = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "int x;\n";
    return text;
  };
  tree.add("components/control/a.cpp", lines(300));
  tree.add("components/control/b.hpp", lines(301));
  tree.add("components/control/c.hpp", lines(301));
  tree.add("components/control/README.md",
           "| `b.hpp` | the rest |\n\nBeside `b.hpp`, `c.hpp` is longer than 300\nlines because it is one table.\n");
  tree.add("components/control/methods/g.py", lines(301));
  tree.add("tests/unit/d.cpp", lines(301));
  tree.add("tests/unit/f.cpp", lines(301));
  tree.add("tests/unit/README.md", "`d.cpp` is longer than 300 lines.\n`f.cpp` is longer than 300 lines because\n");
  tree.add("sim/world/e.yaml", lines(900));
  EXPECT_EQ(text_of(long_files(tree.root())),
            "components/control/b.hpp: 301 lines\ncomponents/control/methods/g.py: 301 lines\ntests/unit/d.cpp: 301 "
            "lines\ntests/unit/f.cpp: 301 lines\n");
}

TEST(LayoutChecker, FindsLongLines) {
  const Tree tree;
  const std::string longest(120, 'x');
  tree.add("components/control/a.cpp", longest + "\n");
  tree.add("components/control/b.hpp", "int x;\n" + longest + "x\n");
  tree.add("components/control/c.yaml", "# " + longest + "\n");
  std::string umlauts;
  for (int i = 0; i < 120; ++i) umlauts += "ö";
  tree.add("sim/world/umlauts.cpp", umlauts + "\n");
  tree.add("tests/README.md", "| " + longest + " |\n- [link](" + longest + ").\n[a link](" + longest + ")\n" + longest +
                                  "x\na " + longest + "\n");
  tree.add("CONTRIBUTING.md", longest + " and more\n");
  tree.add("scripts/run.sh", longest + "x\n");
  EXPECT_EQ(text_of(long_lines(tree.root())),
            "CONTRIBUTING.md:1: 129 columns\ncomponents/control/b.hpp:2: 121 columns\n"
            "components/control/c.yaml:1: 122 columns\nscripts/run.sh:1: 121 columns\n"
            "tests/README.md:3: 130 columns\ntests/README.md:5: 122 columns\n");
}

TEST(LayoutChecker, FindsBrokenLinks) {
  const Tree tree;
  tree.add("README.md",
           "# The `robot`, in *short*\n[a](sim/README.md) [b](sim/none.png)\n"
           "[c](#the-robot-in-short) [d](#other) [e](https://example.org/x)\n");
  tree.add("sim/README.md", "[up](../README.md#the-robot-in-short)\n\n[up](../README.md#nothing)\n");
  EXPECT_EQ(text_of(broken_links(tree.root())),
            "README.md:2: sim/none.png\nREADME.md:3: #other\nsim/README.md:3: ../README.md#nothing\n");
}

}  // namespace
}  // namespace constrictor::testing
