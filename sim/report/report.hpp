// The component `report`: compares what the robot did with ground truth, writes mission.json and figure.png, and ends
// the run.
#pragma once

#include <cereal/types/deque.hpp>
#include <cereal/types/string.hpp>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "component/concluding.hpp"
#include "robot/robot_model.hpp"
#include "sim/report/files.hpp"
#include "sim/report/ledger.hpp"
#include "sim/report/moments.hpp"
#include "sim/report/report_config.hpp"
#include "sim/report/statistics.hpp"

namespace constrictor {

struct ReportState {
  report::RootMeanSquare cross_track;   ///< [m] distance of the head from the line while follow_line runs
  report::RootMeanSquare pose_error_m;  ///< position error of RobotPose, in M
  report::RootMeanSquare pose_error_rad;
  report::Effort effort;
  std::uint64_t percepts_following = 0;  ///< number of line percepts while follow_line runs
  std::uint64_t percepts_visible = 0;    ///< number of these percepts in which the line was visible
  report::PoseAtTick start;              ///< X_WM: pose of the head at the start of the run
  std::deque<report::PoseAtTick> heads;  ///< true poses of the last ticks: an estimate may belong to an earlier tick
  report::ObjectLedger ledger;
  report::BelievedLedger believed;  ///< used if there is no ground truth
  report::MomentAlbum album;
  std::uint64_t torques_length = 0;  ///< [byte] length of each journal
  std::uint64_t events_length = 0;
  std::uint64_t states_length = 0;
  std::uint64_t parameters_length = 0;
  std::string mission_state;  ///< newest state in states.jsonl
  std::uint8_t mission = msg::kMissionRunning;
  std::string mission_reason;
  std::uint16_t recoveries = 0;
  std::int64_t mission_end_tick = -1;  ///< -1: the planner has not ended the mission
  std::string run_end_reason;          ///< why the run ended before the mission; empty: it did not
  bool finished = false;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(cross_track, pose_error_m, pose_error_rad, effort, percepts_following, percepts_visible, start, heads,
            ledger, believed, album, torques_length, events_length, states_length, parameters_length, mission_state,
            mission, mission_reason, recoveries, mission_end_tick, run_end_reason, finished);
  }
};

/// The component `report`. It appends long series to journals in Setup::output_dir and writes pictures. The lengths of
/// the journals belong to the state, and pictures are named by tick: a restarted process leaves the same files.
/// Pictures of the scene are drawn from saved world states when the run ends. Without an output directory it judges the
/// mission and ends the run, but writes nothing. It ends the run `settle_s` after the end of the mission, or at
/// `max_sim_time_s`, or later if the mission states a longer limit. If a user or the plant's limit ends the run
/// earlier, it writes the same files, and they give this end as the reason. Without ground truth (a real robot, or
/// emulated hardware), success is the robot's own estimate, and the figures that need ground truth are unknown.
class Report : public ConfiguredComponent<ReportState, ReportConfig>, public Concluding {
 public:
  Report(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;
  void conclude(const Tick& last) override;

 private:
  Report(Wiring& wiring, const Setup& setup, const RobotModel& robot);
  /// Whether the world is known, as it is in a simulation.
  [[nodiscard]] bool truth() const { return world_ && scene_; }
  void read_line();
  void follow_truth();
  [[nodiscard]] bool following_line() const;
  void follow_line();
  void follow_effort(const Tick& tick);
  void follow_events();
  void follow_parameters(const Tick& tick);
  void follow_mission(const Tick& tick);
  void follow_images();
  void journal_torques(const Tick& tick);
  void add_moment(std::int64_t tick, double time_s, std::uint8_t event, std::uint8_t colour);
  /// Records that the run ends while the mission is running: the report shows `reason`, and the figure gets a last row.
  void end_early(const Tick& tick, const std::string& reason);
  /// True if the planner ended the mission successfully and ground truth, if it is known, agrees.
  [[nodiscard]] bool success() const;
  [[nodiscard]] std::string outcome() const;
  /// Why the mission did not succeed; empty on success.
  [[nodiscard]] std::string failure() const;
  // Defined in report_files.cpp.
  void write_files(const Tick& tick);
  [[nodiscard]] std::string mission_json(const Tick& tick, const std::string& figure_error) const;
  [[nodiscard]] nlohmann::ordered_json objects_json() const;
  [[nodiscard]] std::string scenario() const;
  /// Draws the pictures of the scene. Returns why it could not; empty: it could.
  [[nodiscard]] std::string draw_scenes(const std::vector<report::Moment>& moments);
  /// Returns why there is no figure.png; empty: there is.
  [[nodiscard]] std::string draw_figure(const Tick& tick, const std::vector<report::Moment>& moments);
  /// Appends to a journal, if the disk takes it.
  void append(report::Journal& journal, const std::string& text, std::uint64_t& length) {
    lost_.attempt([&] { journal.append(text, length); });
  }

  ReportConfig::Limit limit_;
  std::vector<std::uint8_t> demanded_;  // colours of the mission's objects
  std::string scenario_;                // name of the scenario file, without folder and ending
  std::uint64_t seed_;
  double plant_limit_s_;  // [s] simulated time at which the plant ends the run; 0: never
  std::filesystem::path folder_;
  std::vector<std::size_t> yaw_joints_;
  double mass_kg_;                 // of all modules
  Eigen::Vector3d head_camera_m_;  // p_HC, for the pictures of the scene
  report::Journal torques_, events_, states_, parameters_;
  Log log_;
  report::LostFiles lost_;
  std::vector<Eigen::Vector2d> line_m_;  // points of the line in W, from the scene
  Latest<msg::WorldState> world_ = wiring_.latest(topics::kWorldState);
  Latest<msg::SceneDescription> scene_ = wiring_.latest(topics::kSceneDescription);
  Latest<msg::RobotPose> pose_ = wiring_.latest(topics::kRobotPose);
  Latest<msg::TaskStatus> task_ = wiring_.latest(topics::kTaskStatus);
  Events<msg::TaskEvent> task_events_ = wiring_.events(topics::kTaskEvent);
  Events<msg::ParameterChange> parameter_changes_ = wiring_.events(topics::kParameterChange);
  Latest<msg::MissionStatus> mission_ = wiring_.latest(topics::kMissionStatus);
  Latest<msg::JointState> joints_ = wiring_.latest(topics::kJointState);
  Latest<msg::LinePercept> line_ = wiring_.latest(topics::kLinePercept);
  Latest<msg::CameraImage> camera_ = wiring_.latest(topics::kCameraImage);
  Latest<msg::CameraImage> processed_ = wiring_.latest(topics::kProcessedImage);
};

ComponentFactory make_report_factory();

}  // namespace constrictor
