// A look at one DDS domain: who is there, once discovery has settled.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "runtime/dds/discovery.hpp"
#include "runtime/dds/domain.hpp"

namespace constrictor::cli {

/// What the commands that look have in common.
struct ViewOptions {
  std::optional<std::uint32_t> domain;
  bool json = false;
};

/// Adds --run and --json.
void add_view_options(CLI::App& app, ViewOptions& options);

/// What a member of the barrier says of itself.
struct Member {
  std::optional<msg::Hello> hello;
  std::optional<msg::ComponentStatus> status;
};

/// The domain that the options name, or that of the only run there is. Throws RegistryError.
std::uint32_t chosen_domain(const ViewOptions& options);

class DomainView {
 public:
  /// Joins the domain that the options name, or that of the only run there is. Throws RegistryError or dds::Error.
  explicit DomainView(const ViewOptions& options);
  /// Waits until discovery brings nothing new for a moment, at most `bound`; returns false if nobody is there.
  bool settle(std::chrono::milliseconds bound = std::chrono::milliseconds(1500)) const;
  /// Waits until `topic` has a writer, at most `bound`.
  [[nodiscard]] std::optional<dds::Endpoint> find_writer(const std::string& topic, std::chrono::milliseconds bound) const;
  /// Every Hello and status by component; of a component that speaks with several voices the newest incarnation.
  [[nodiscard]] std::map<std::string, Member> members() const;

  [[nodiscard]] std::uint32_t domain() const { return number_; }
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }
  [[nodiscard]] const dds::Discovery& discovery() const { return discovery_; }
  /// Components of a participant by its endpoints' user data, or its program's name.
  [[nodiscard]] static std::string name_of(const dds::Guid& participant, const std::vector<dds::Participant>& participants,
                                           const std::vector<dds::Endpoint>& endpoints);

 private:
  std::uint32_t number_;
  dds::Domain domain_;
  dds::Discovery discovery_;
};

/// True once SIGINT or SIGTERM came; the first call begins to listen.
bool interrupted();

}  // namespace constrictor::cli
