// The common part of the commands that act as an operator.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/request_client.hpp"

namespace constrictor {

/// Options of a client with the level of an operator, whose waits end at Ctrl-C (it calls catch_interrupts()).
/// If `lease` is 0, authority ends with the process; otherwise it also ends when the process hangs for this time. If
/// `detached` is true, authority lasts until a source releases it (for scripts).
RequestClientOptions operator_options(std::string source, std::chrono::milliseconds lease = {}, bool detached = false);

/// Connects and returns 0. If `input` does not answer, or at Ctrl-C, prints what to do and returns an exit status. The
/// text goes also to `reason`, for the output of --json, if it is not null.
int connect(RequestClient& client, const char* command, std::string* reason = nullptr);

/// Prints why a request was not granted and what to do; `command` begins the message. Returns the exit status.
int report_not_granted(RequestClient& client, RequestClient::Answer answer, const char* command);

/// The holder of authority, for people: "authority: operator task", "authority: none". `authority`: empty before the
/// first message.
std::string authority_text(const std::optional<msg::Authority>& authority);
/// Why the source `own` has no authority (any more), and what to do about an emergency stop.
std::string no_authority_text(const std::optional<msg::Authority>& authority, const std::string& own);

}  // namespace constrictor
