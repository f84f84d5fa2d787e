// The run's judge: compares what the robot did with ground truth, writes mission.json and figure.png, and ends the run.
#pragma once

#include <cereal/types/deque.hpp>
#include <cereal/types/string.hpp>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "runtime/concluding.hpp"
#include "sim/report/files.hpp"
#include "sim/report/ledger.hpp"
#include "sim/report/moments.hpp"
#include "sim/report/statistics.hpp"

namespace constrictor {

/// report.yaml.
struct ReportConfiguration {
  double max_sim_time_s = 400.0;      ///< [s] a run that has not ended by then has failed
  double settle_s = 2.0;              ///< [s] from the mission's end to the verdict
  int torque_decimation_ticks = 5;    ///< ticks from one sample of the torque journal to the next
  double torque_window_s = 30.0;      ///< [s] shown in each torque plot of the figure
};

ReportConfiguration load_report(const std::filesystem::path& file);

struct ReportState {
  report::RootMeanSquare cross_track;        ///< [m] head from the line while follow_line runs
  report::RootMeanSquare pose_error_m;       ///< RobotPose against ground truth, in the frame M
  report::RootMeanSquare pose_error_rad;
  std::uint64_t percepts_following = 0;      ///< line percepts while follow_line runs,
  std::uint64_t percepts_visible = 0;        ///< and those of them that saw the line
  report::PlanarPose start;                  ///< head at the run's start: frame M in W
  std::deque<report::PlanarPose> heads;      ///< recent truth, for estimates of earlier ticks
  report::ObjectLedger ledger;
  report::MomentAlbum album;
  std::uint64_t torques_length = 0;          ///< [byte] of the journals
  std::uint64_t events_length = 0;
  std::uint64_t states_length = 0;
  std::uint64_t parameters_length = 0;
  std::string mission_state;                 ///< last one journaled
  std::uint8_t mission = msg::kMissionRunning;
  std::string mission_reason;
  std::uint16_t recoveries = 0;
  std::int64_t mission_end_tick = -1;
  bool finished = false;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(cross_track, pose_error_m, pose_error_rad, percepts_following, percepts_visible, start, heads, ledger, album,
            torques_length, events_length, states_length, parameters_length, mission_state, mission, mission_reason, recoveries, mission_end_tick, finished);
  }
};

/// Component `report`. Long series go to journals in Setup::output_dir whose lengths are in the state, pictures to files named
/// by tick: a restarted process leaves the same files. With no output_dir it judges and ends the run but writes nothing.
/// It ends the run `settle_s` after the mission's end, or at `max_sim_time_s`; if something else ends it, it tells what there is.
class Report : public StatefulComponent<ReportState>, public Concluding {
 public:
  Report(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;
  void conclude(const Tick& last) override;

 private:
  void follow_truth();
  void follow_events();
  void follow_parameters(const Tick& tick);
  void follow_mission(const Tick& tick);
  void follow_images();
  void journal_torques(const Tick& tick);
  void add_moment(std::int64_t tick, double time_s, std::uint8_t event, std::uint8_t colour);
  void write_files(const Tick& tick) const;
  /// The planner believes it, and ground truth agrees.
  [[nodiscard]] bool success() const;
  [[nodiscard]] std::string mission_json(const Tick& tick) const;
  void draw(const Tick& tick) const;

  Wiring& wiring_;
  ReportConfiguration configuration_;
  std::filesystem::path folder_;
  std::vector<std::size_t> yaw_joints_;
  report::Journal torques_, events_, states_, parameters_;
  std::vector<Eigen::Vector2d> line_m_;  // from the scene
  Latest<msg::WorldState> world_;
  Latest<msg::SceneDescription> scene_;
  Latest<msg::RobotPose> pose_;
  Latest<msg::TaskStatus> task_;
  Events<msg::TaskEvent> task_events_;
  Events<msg::ParameterChange> parameter_changes_;
  Latest<msg::MissionStatus> mission_;
  Latest<msg::JointState> joints_;
  Latest<msg::LinePercept> line_;
  Latest<msg::CameraImage> camera_;
  Latest<msg::CameraImage> processed_;
  Latest<msg::CameraImage> overview_;
};

ComponentFactory make_report_factory();

}  // namespace constrictor
