#include "common/operator.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "client/task_names.hpp"
#include "common/interrupt.hpp"
#include "runtime/host.hpp"

namespace constrictor {

RequestClientOptions operator_options(std::string source, std::chrono::milliseconds lease, bool detached) {
  catch_interrupts();
  RequestClientOptions options;
  options.source = std::move(source);
  options.level = msg::kAuthorityOperator;
  options.lease = lease;
  options.lease_by_hand = lease.count() > 0;
  options.detached = detached;
  options.interrupted = [] { return interrupt_signal() != 0; };
  return options;
}

int connect(RequestClient& client, const char* command, std::string* reason) {
  try {
    client.connect_or_throw(std::chrono::seconds(5));
    return exit_status::kOk;
  } catch (const CommandError& error) {
    std::fprintf(stderr, "%s: %s\n", command, error.what());
    if (reason) *reason = error.what();
    return error.cause() == CommandError::Cause::kInterrupted ? interrupt_status() : exit_status::kWaitedTooLong;
  }
}

int report_not_granted(RequestClient& client, RequestClient::Answer answer, const char* command) {
  using Answer = RequestClient::Answer;
  switch (answer) {
    case Answer::kGranted:
      return exit_status::kOk;
    case Answer::kRefused:
      std::fprintf(stderr, "%s: refused: %s\n", command, client.refusal().c_str());
      if (client.authority() && client.authority()->emergency_stop)
        std::fprintf(stderr, "  `constrictor clear-stop` clears the emergency stop\n");
      return exit_status::kFailed;
    case Answer::kNone:
      client.flush();
      std::fprintf(stderr,
                   "%s: no answer within 5 s. If the run is paused, the request is obeyed when the run resumes "
                   "(`constrictor resume`); otherwise see `constrictor status`\n",
                   command);
      return exit_status::kWaitedTooLong;
    case Answer::kInterrupted:
      break;
  }
  client.flush();
  std::fprintf(stderr, "%s: interrupted before the answer; the request was sent and may still be obeyed (%s)\n",
               command, authority_text(client.authority()).c_str());
  return interrupt_status();
}

std::string authority_text(const std::optional<msg::Authority>& authority) {
  if (!authority) return "authority: not known";
  const bool named = *authority->source != '\0' && authority->level != msg::kAuthorityPlanner;
  return fmt::format("authority: {}{}{}", authority_name(authority->level), named ? " " : "",
                     named ? authority->source : "");
}

std::string no_authority_text(const std::optional<msg::Authority>& authority, const std::string& own) {
  if (!authority || !authority->emergency_stop) {
    const bool taken = authority && authority->level != msg::kAuthorityNone;
    return fmt::format("{} ({})", taken ? "another source has authority" : "no source has authority",
                       authority_text(authority));
  }
  return fmt::format("the emergency stop of {} is latched; the robot holds its posture until `constrictor clear-stop`",
                     own == authority->source ? "this program" : authority->source);
}

}  // namespace constrictor
