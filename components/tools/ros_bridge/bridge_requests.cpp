// Requests of ROS programs (velocities, tasks, emergency stops), and the reports on tasks that they receive.
#include "constrictor/text.hpp"
#include "ros_bridge/bridge.hpp"
#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {

using namespace std::chrono_literals;

void Bridge::take_stops(SteadyClock::time_point now) {
  client_.poll();
  bool stop = false;
  bool clear = false;
  stop_.take([&](const Empty&) { stop = true; });
  best_effort_stop_.take([&](const Empty&) { stop = true; });
  clear_stop_.take([&](const Empty&) { clear = true; });
  const auto& authority = client_.authority();
  const bool stopped = authority && authority->emergency_stop;
  if (stop_number_ != 0 && client_.answer(stop_number_)) stop_number_ = 0;
  // A button may repeat the stop many times a second. The client repeats an unanswered stop by itself.
  if (stop && !stopped && (stop_number_ == 0 || now - stop_asked_ > 500ms)) {
    stop_number_ = client_.ask(msg::kRequestEmergencyStop);
    stop_asked_ = now;
    own_log_.warning("emergency stop from ROS 2");
  }
  if (clear && !stop) clear_number_ = client_.ask(msg::kRequestClearStop);
  if (const msg::RequestAnswer* answer = client_.answer(clear_number_)) {
    clear_number_ = 0;
    if (!answer->granted) desk_.refuse("emergency_stop/clear", printable(text_of(answer->reason)));
  }
  if (authority && stopped_ != stopped) {
    stopped_ = stopped;
    stopped_out_.write({stopped});
  }
}

void Bridge::take_velocities(SteadyClock::time_point now) {
  const double now_s = std::chrono::duration<double>(now.time_since_epoch()).count();
  pilot_.task(desk_.busy() || desk_.keeps_authority());
  velocity_.take([&](const Twist& twist) { pilot_.command(drive_of(twist, options_.drive), now_s); });
  if (const msg::RequestAnswer* answer = client_.answer(number_)) {
    number_ = 0;
    pilot_.answered(answer->granted);
    if (answer->granted) refusal_.clear();
    else if (refusal_ != answer->reason) own_log_.warning("cmd_vel is refused: {}", refusal_ = answer->reason);
  }
  if (client_.authority()) pilot_.authority(client_.holds_authority(), client_.authority()->emergency_stop, now_s);
  const bool steered = velocity_.writers() > 0 || task_.writers() > 0 || desk_.busy() || desk_.keeps_authority();
  if (const auto request = pilot_.next(client_.connected(), steered, now_s)) {
    if (request->kind != msg::kRequestMotion) number_ = client_.ask(request->kind);
    else if (request->drive == Drive{}) number_ = client_.move(msg::kMotionStand);
    else number_ = client_.move(msg::kMotionDrive, request->drive.speed_m_s, request->drive.curvature_1_m);
  }
}

void Bridge::take_task_lines(SteadyClock::time_point now) {
  task_.take([&](const Text& message) {
    const std::string line = message.data ? message.data : "";
    const auto parsed = parse_task_line(line);
    if (const auto* problem = std::get_if<std::string>(&parsed)) return desk_.refuse(line, *problem);
    if (!client_.connected()) return desk_.refuse(line, "`input` does not read requests; see `constrictor doctor`");
    if (desk_.waiting().size() >= kMostWaitingTasks)
      return desk_.refuse(line, "too many earlier requests wait for their answers");
    const auto& what = std::get<TaskLine>(parsed);
    using Kind = TaskLine::Kind;
    const std::uint64_t number = what.kind == Kind::kStart    ? client_.ask(what.request)
                                 : what.kind == Kind::kCancel ? client_.move(msg::kMotionStand)
                                 : what.kind == Kind::kTake   ? client_.ask(msg::kRequestTake)
                                                              : client_.ask(msg::kRequestRelease);
    desk_.sent(line, what, number, now);
  });
  for (const std::uint64_t number : desk_.waiting()) {
    if (const msg::RequestAnswer* answer = client_.answer(number)) desk_.answered(*answer);
  }
  desk_.look(client_.goals(), now);
  for (const std::string& answer : desk_.answers()) say(task_answer_out_, answer);
}

void Bridge::say(const dds::Writer<Text>& writer, const std::string& words) { writer.write({text(words)}); }

void Bridge::pass_tasks() {
  task_status_.take([this](const msg::TaskStatus& status) {
    if (validate(status)) return;
    if (plan_goal_ != 0 && status.goal_id == plan_goal_ && status.goal_state >= msg::kGoalSucceeded) {
      plan_goal_ = 0;
      msg::TaskCommand none{};
      none.header = status.header;
      plan_out_.write(drawing_.plan(none));
    }
    msg::TaskStatus coarse = status;
    coarse.progress = std::floor(10 * status.progress) / 10;  // so that not every tick has news
    std::string words = task_status_json(coarse);
    if (words == last_task_status_) return;
    last_task_status_ = std::move(words);
    say(task_status_out_, last_task_status_);
  });
  task_event_.take([this](const msg::TaskEvent& event) {
    if (!validate(event)) say(task_event_out_, task_event_json(event));
  });
}

}  // namespace constrictor::ros_bridge
