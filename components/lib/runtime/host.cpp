#include "runtime/host.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "cyclone/acknowledgements.hpp"
#include "cyclone/own_host.hpp"
#include "runtime/conductor_side.hpp"
#include "runtime/config_hash.hpp"
#include "runtime/host_context.hpp"
#include "runtime/links.hpp"
#include "runtime/log_publisher.hpp"
#include "runtime/member_side.hpp"
#include "runtime/version.hpp"
#include "runtime/version_text.hpp"

namespace constrictor {
namespace {

constexpr double kWaitingReportAfter_s = 2.0;
constexpr double kWaitForLastInputs_s = 5.0;  // of a member that is restarted at the end of the run
constexpr auto kWaitingReportInterval = std::chrono::seconds(1);

// Bounds on the time in which a process that ends waits until its last messages have been received.
constexpr dds_duration_t kWaitForMembers_ns = DDS_SECS(2);   // the plant's process, while a member has not ended
constexpr dds_duration_t kWaitForLauncher_ns = DDS_SECS(1);  // the plant's last status shows it that the run is over
constexpr dds_duration_t kWaitAlone_ns = DDS_MSECS(500);     // every other process, for readers that are not members

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

std::string names_of(const std::vector<ComponentFactory>& factories) {
  std::vector<std::string> names;
  for (const auto& factory : factories) names.push_back(factory.name);
  return fmt::format("{}", fmt::join(names, ","));
}

/// The name of the identity of a process in a secured run: its components, joined by "+" as in the names of its files.
std::string security_identity(std::string components) {
  std::replace(components.begin(), components.end(), ',', '+');
  return components;
}

HostContext make_context(HostOptions options, const std::vector<ComponentFactory>& factories) {
  const std::string identity = names_of(factories);
  const std::string config_hash = run_config_hash(options.setup.robot_file, options.roster, options.plant,
                                                  options.latency_ticks, options.faults_file);
  return {std::move(options), identity, config_hash, own_host()};
}

/// The first line of each process: what is needed to know which build with which configuration it is.
std::string banner(const HostContext& context) {
  const HostOptions& options = context.options;
  const char* launcher = std::getenv(kLauncherVariable);
  return fmt::format(
      "starts: Constrictor {}, git {}, IDL {:.12}, domain {}, configuration {:.12}, incarnation {}, pid {} on {}{}",
      kVersion, own_git_revision(), msg::kIdlHash, options.domain, context.config_hash, options.incarnation, ::getpid(),
      context.host_name, launcher ? fmt::format(", started by {}", launcher) : "");
}

}  // namespace

class Host::Impl {
 public:
  Impl(HostOptions options, std::vector<ComponentFactory> factories)
      : context_(make_context(std::move(options), factories)),
        links_(context_.options.domain, security_identity(context_.identity)),
        log_publisher_(links_.participant(), context_.log, context_.identity, context_.options.incarnation),
        members_(context_, links_, std::move(factories)) {
    context_.log.info("{}", banner(context_));
    links_.on_rejected([this](const std::string& topic, const std::string& reason) { members_.reject(topic, reason); });
    if (!members_.plant()) return;
    conductor_ = std::make_unique<ConductorSide>(context_, links_, members_);
    members_.connect(*conductor_);
  }

  int run() {
    if (!g_stop) members_.send_hello();
    if (conductor_) conductor_->continue_epoch();
    links_.take_all();
    if (may_step_in_receiver()) links_.let_receiver_turn([this] { return turn(); });
    while (!context_.exit_status && !g_stop) {
      members_.repeat_hello();
      members_.send_ready();
      const bool stepped = step();
      const bool ticked = conductor_ && conductor_->tick();
      if (stepped || ticked) context_.note_progress();
      if (conductor_) {
        conductor_->poll_recording();
        conductor_->publish_run_state(false);
        conductor_->expect_done();
      }
      if (members_.all_ended() && !stays()) break;
      // After a tick, the member of this process steps before it is clear whether it lacks inputs.
      links_.wait(ticked ? 0 : longest_wait_ns(), !ticked && members_.want_inputs());
      if (!stepped && !ticked) check_patience();
    }
    const int status = context_.exit_status.value_or(exit_status::kOk);
    members_.finish();
    wait_for_readers();
    if (conductor_) conductor_->finish();
    return status;
  }

 private:
  bool step() {
    bool stepped = false;
    while (members_.step()) stepped = true;  // the outputs of one member may let another one step
    return stepped;
  }

  /// A writer whose history is full waits for acknowledgements, which it would not get in the thread that receives
  /// them. With this project's DDS configuration no history is ever full (WhcHigh). A user's configuration may have
  /// another limit; this function then returns false.
  [[nodiscard]] bool may_step_in_receiver() const {
    return members_.have_short_steps() && !conductor_ && !std::getenv("CYCLONEDDS_URI");
  }

  /// In the thread that receives. Returns whether there is something to do besides steps.
  bool turn() {
    if (step()) context_.note_progress();
    links_.want(members_.want_inputs());
    return context_.exit_status || !members_.all_ready() || members_.all_ended();
  }

  /// Whether this process is still needed, although its members have ended. The plant's process waits for the members
  /// of the others. These stay until it has left: a member that is restarted now needs the last samples of all others,
  /// and DDS drops the samples of a process that leaves.
  bool stays() {
    if (conductor_) return conductor_->stays();
    if (!members_.plant_lives()) return false;
    if (!staying_) members_.publish_last_statuses();  // the plant's process waits for them
    staying_ = true;
    context_.note_progress();
    return true;
  }

  /// Waits until the last messages have been received. An observer that was killed or stopped delays the end of the run
  /// no longer than it takes to be sure that no member needs a message any more. Where the plant is in another process,
  /// stays() has made sure of that.
  void wait_for_readers() const {
    const bool ended = members_.all_ended();
    const bool alone = ended && !conductor_;
    dds_duration_t bound_ns = kWaitForLauncher_ns;
    if (alone) bound_ns = kWaitAlone_ns;
    else if (ended && !conductor_->all_ended()) bound_ns = kWaitForMembers_ns;
    dds::wait_for_acknowledgements(links_.participant(), bound_ns, [alone] { return alone && g_stop != 0; });
  }

  [[nodiscard]] dds_duration_t longest_wait_ns() const {
    const dds_duration_t idle_ns = members_.all_ready() && !staying_ ? DDS_MSECS(100) : DDS_MSECS(10);
    return conductor_ ? std::min<dds_duration_t>(conductor_->wait_ns(), idle_ns) : idle_ns;
  }

  /// Reports what this process waits for, and ends it when it has waited too long.
  void check_patience() {
    if (members_.stepping() || (conductor_ && conductor_->held())) context_.note_progress();
    context_.note_waiting();
    const double waited_s = context_.waited_s();
    if (waited_s > kWaitForLastInputs_s) members_.conclude_anyway();
    const auto now = HostContext::Clock::now();
    if (waited_s < kWaitingReportAfter_s || now - last_report_ < kWaitingReportInterval) return;
    last_report_ = now;
    if (conductor_) conductor_->report_waiting();
    members_.report_waiting();
    if (context_.options.patience_s > 0 && waited_s > context_.options.patience_s) {
      context_.log.error("gave up after {:.0f} s of waiting; the lines above name what was missing", waited_s);
      context_.exit_status = exit_status::kWaitedTooLong;
    }
  }

  HostContext context_;
  Links links_;
  LogPublisher log_publisher_;
  MemberSide members_;
  std::unique_ptr<ConductorSide> conductor_;  ///< null: the plant is in another process
  HostContext::Clock::time_point last_report_ = HostContext::Clock::now();
  bool staying_ = false;
};

Host::Host(HostOptions options, std::vector<ComponentFactory> factories)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(factories))) {}
Host::~Host() = default;
void Host::heed_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
}
int Host::run() { return impl_->run(); }

}  // namespace constrictor
