#include "runtime/links.hpp"

#include <algorithm>

#include "cyclone/acknowledgements.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor {

Links::Links(std::uint32_t domain, const std::string& identity)
    : domain_((dds::Mailbox::open_for_this_process(),
               dds::create_domain(domain, dds::Reach::kLoopback, dds::kNoLinger))),
      participant_(dds::create_participant(domain, dds::Reach::kLoopback, identity)),
      wait_set_(dds_create_waitset(participant_.get()), "dds_create_waitset"),
      always_wait_set_(dds_create_waitset(participant_.get()), "dds_create_waitset"),
      woken_(dds_create_guardcondition(participant_.get()), "dds_create_guardcondition") {
  const auto reset = [this] {
    bool woken = false;
    dds::check(dds_take_guardcondition(woken_.get(), &woken), "dds_take_guardcondition");
  };
  attach_to_wait_sets(woken_.get(), reset, Wakes::kAlways);
}

void Links::wake() { dds::check(dds_set_guardcondition(woken_.get(), true), "dds_set_guardcondition"); }

void Links::attach(dds_entity_t reader, std::function<void()> take, Wakes wakes) {
  dds::wake_by_samples_only(reader);
  attach_to_wait_sets(reader, std::move(take), wakes);
}

void Links::attach_to_wait_sets(dds_entity_t entity, std::function<void()> take, Wakes wakes) {
  dds::check(dds_waitset_attach(wait_set_.get(), entity, static_cast<dds_attach_t>(takers_.size())),
             "dds_waitset_attach");
  if (wakes == Wakes::kAlways) dds::check(dds_waitset_attach(always_wait_set_.get(), entity, 0), "dds_waitset_attach");
  takers_.push_back(std::move(take));
  triggered_.resize(takers_.size());
}

void Links::take_all() {
  for (const auto& take : takers_) take();
}

void Links::wait(dds_duration_t bound_ns, bool wanted) {
  if (wanted && !emptied_at_once_) emptied_at_once_.emplace();
  else if (!wanted) emptied_at_once_.reset();
  if (!wanted && bound_ns > 0) {
    dds::check(dds_waitset_wait(always_wait_set_.get(), nullptr, 0, bound_ns), "dds_waitset_wait");
    bound_ns = 0;
  }
  const int count =
      dds::check(dds_waitset_wait(wait_set_.get(), triggered_.data(), triggered_.size(), bound_ns), "dds_waitset_wait");
  const std::size_t used = std::min<std::size_t>(static_cast<std::size_t>(count), triggered_.size());
  for (std::size_t i = 0; i < used; ++i) takers_[static_cast<std::size_t>(triggered_[i])]();
}

}  // namespace constrictor
