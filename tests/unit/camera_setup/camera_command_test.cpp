// The subcommands of `constrictor camera` with live sources, and with files and sources that do not work.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "component/data_path.hpp"
#include "robot/robot_model.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"
#include "video/calibration.hpp"

namespace constrictor::camera_setup {
namespace {

using namespace std::chrono_literals;

/// A live source that needs no camera.
const std::string kPipeline =
    "videotestsrc is-live=true pattern=ball ! video/x-raw,width=320,height=240,framerate=10/1 ! videoconvert ! appsink";

TEST(CameraCommand, AMountWithoutABoardInViewSaysWhatItSeesAndEnds) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "camera.yaml").string();
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  std::ofstream(file) << video::calibration_text(video::calibration_of(robot.camera), false, "this test");
  const auto mount = [&](const std::string& within) {
    return testing::Process({testing::program("camera_setup"), "mount", "--source", kPipeline, "--calibration", file,
                             "--at", "0.36,0", "--board", "6x5", "--square", "0.04", "--within", within});
  };
  testing::Process bounded = mount("3");
  EXPECT_EQ(bounded.wait(60s), 1) << bounded.errors();
  EXPECT_NE(bounded.output().find("no board of 6 x 5 corners in view: 1 pictures of 320 x 240"), std::string::npos)
      << bounded.output();
  EXPECT_NE(bounded.errors().find("within 3 s (--within)"), std::string::npos) << bounded.errors();
  testing::Process stopped = mount("600");
  ASSERT_TRUE(stopped.wait_for("no board", 30s)) << stopped.errors();
  stopped.signal(SIGINT);
  EXPECT_EQ(stopped.wait(30s), 128 + SIGINT) << stopped.errors();
}

TEST(CameraCommand, EachSubcommandShowsAnExampleOfItself) {
  for (const std::string name : {"show", "calibrate", "mount", "colours"}) {
    testing::Process help({testing::program("camera_setup"), name, "--help"});
    EXPECT_EQ(help.wait(20s), 0) << help.errors();
    EXPECT_NE(help.output().find("EXAMPLES\n  constrictor camera " + name + " --"), std::string::npos) << help.output();
  }
}

TEST(CameraCommand, AFileThatCannotBeWrittenIsRefusedBeforeTheSourceIsOpened) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "camera.yaml").string();
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  std::ofstream(file) << video::calibration_text(video::calibration_of(robot.camera), false, "this test");
  const std::string nowhere = (folder.path() / "no_such_folder" / "out.yaml").string();
  for (std::vector<std::string> words : std::vector<std::vector<std::string>>{
           {"calibrate", "--square", "0.03", "--out", nowhere},
           {"calibrate", "--square", "0.03", "--out", folder.path().string()},
           {"mount", "--square", "0.03", "--calibration", file, "--at", "0.36,0", "--out", nowhere},
           {"colours", "--sample", "blue=0,0,9,9", "--out", nowhere}}) {
    words.insert(words.begin(), testing::program("camera_setup"));
    words.insert(words.end(), {"--source", kPipeline});
    testing::Process process(std::move(words));
    EXPECT_EQ(process.wait(20s), 1) << process.output() << process.errors();
    EXPECT_NE(process.errors().find("--out: "), std::string::npos) << process.errors();
    EXPECT_EQ((process.output() + process.errors()).find("320 x 240"), std::string::npos) << "the source was opened";
  }
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

TEST(CameraCommand, ShowWritesPicturesAndRefusesOtherEndings) {
  const testing::TemporaryFolder folder;
  const auto show = [&](const std::string& name, int status) -> std::string {
    testing::Process process(
        {testing::program("camera_setup"), "show", "--source", kPipeline, "--out", (folder.path() / name).string()});
    EXPECT_EQ(process.wait(60s), status) << process.output() << process.errors();
    return process.output() + process.errors();
  };
  for (const char* name : {"pic.foo", "pic"}) {
    const std::string text = show(name, 64);
    EXPECT_NE(text.find("accepted a name with one of the endings .png, .jpg"), std::string::npos) << text;
    EXPECT_EQ(text.find("OpenCV"), std::string::npos) << text;
  }
  show("pic.PNG", 0);
  EXPECT_EQ(cv::imread((folder.path() / "pic.PNG").string()).size(), cv::Size(320, 240));
}

TEST(CameraCommand, ShowCountsMissingFramesOnlyOfARateThatIsGiven) {
  const auto show = [&](std::vector<std::string> more) -> std::string {
    std::vector<std::string> words = {testing::program("camera_setup"), "show", "--source", kPipeline};
    words.insert(words.end(), more.begin(), more.end());
    testing::Process process(std::move(words));
    EXPECT_EQ(process.wait(60s), 0) << process.errors();
    return process.output();
  };
  const std::string measured = show({});
  EXPECT_NE(measured.find("frames in a second"), std::string::npos) << measured;
  EXPECT_EQ(measured.find("missing"), std::string::npos) << measured;
  const std::string expected = show({"--rate", "30"});  // the source sends 10 in a second
  EXPECT_NE(expected.find(" missing of "), std::string::npos) << expected;
  EXPECT_EQ(expected.find(" 0 missing"), std::string::npos) << expected;
}

TEST(CameraCommand, ASourceThatCannotBeOpenedHasAStatusOfItsOwn) {
  const testing::TemporaryFolder folder;
  for (const char* source : {"http://127.0.0.1:9/stream", "/dev/video_that_is_not_there"}) {
    testing::Process process({testing::program("camera_setup"), "show", "--source", source});
    EXPECT_EQ(process.wait(60s), 70) << process.errors();
    EXPECT_NE(process.errors().find("the source could not be opened for 5 s"), std::string::npos) << process.errors();
    EXPECT_EQ(process.errors().find("constrictor camera show"), std::string::npos) << process.errors();
  }
}

}  // namespace
}  // namespace constrictor::camera_setup
