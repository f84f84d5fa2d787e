// A report that cannot draw, because its modules are missing, still writes the verdict, and says what is missing.
#include "mission_run.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;

TEST_F(MissionRun, AReportThatCannotDrawWritesItsVerdict) {
  for (const char* name : {"constrictor", "constrictor_host"}) fs::copy_file(program(name), dir_ / name);
  Process process({(dir_ / "constrictor").string(), "run", "line", "--in-process", "--max-sim-time", "3", "--report",
                   (dir_ / "out").string()},
                  {{"CONSTRICTOR_DATA", source_path().string()}});
  EXPECT_EQ(process.wait(std::chrono::seconds(60)), exit_status::kFailed) << process.output() << process.errors();
  const auto report = nlohmann::json::parse(std::ifstream(dir_ / "out" / "report.json"), nullptr, false);
  ASSERT_TRUE(report.is_object()) << process.output() << process.errors();
  EXPECT_EQ(report["reason"], "time limit of 3 s (--max-sim-time)");
  EXPECT_NE(report["figure_error"].get<std::string>().find("cannot load the module of the scene"), std::string::npos);
  EXPECT_FALSE(report["events"].empty());
  EXPECT_NE((process.output() + process.errors()).find("the figure is missing or incomplete: cannot load the module"),
            std::string::npos)
      << process.output() << process.errors();
}

}  // namespace
}  // namespace constrictor::testing
