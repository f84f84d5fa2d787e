#include "conform/member_process.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"

namespace constrictor::conform {
namespace {

constexpr int kDepth = 8;

}  // namespace

MemberProcess::MemberProcess(dds_entity_t participant, std::string member)
    : member_(std::move(member)),
      status_(dds::Reader<msg::ComponentStatus>::observer(participant, barrier_topics::kStatus.name, kDepth)) {}

void MemberProcess::look() {
  status_.take([&](const msg::ComponentStatus& status) {
    if (constrictor::text_of(status.component) != member_) return;
    incarnation_ = status.incarnation;
    pid_ = status.pid;
    refused_ = status.refused_count;
    status_tick_ = status.tick;
    status_epoch_ = status.epoch;
  });
}

std::string MemberProcess::kill() {
  look();
  if (pid_ <= 1) return fmt::format("{} has reported no process", member_);
  if (::kill(pid_, SIGKILL) != 0)
    return fmt::format("process {} of {} cannot be killed: {}", pid_, member_, ::strerrordesc_np(errno));
  return {};
}

}  // namespace constrictor::conform
