// Requests without parameters, to be filled in.
#include <limits>

#include "client/request_client.hpp"

namespace constrictor {

msg::TaskParameters no_parameters() {
  msg::TaskParameters parameters{};
  parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  return parameters;
}

msg::Request task_request(std::uint8_t task) {
  msg::Request request{};
  request.kind = msg::kRequestTask;
  request.command = msg::kCommandStart;
  request.task = task;
  request.parameters = no_parameters();
  return request;
}

}  // namespace constrictor
