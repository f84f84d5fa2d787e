// Typed DDS readers and writers with the qualities of service of this project: member, command and observer.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/descriptors.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/entity.hpp"
#include "cyclone/writer_book.hpp"

namespace constrictor::dds {

/// The checks of a reader against foreign writers. The reader keeps the pointers, which must outlive it.
struct ReaderGuard {
  WriterBook* book = nullptr;  ///< notes the writers; null: none does
  /// Called by DDS, in any thread, before a sample costs the reader any memory: false drops the sample. Null: all pass.
  bool (*passes)(const void* message, void* argument) = nullptr;
  void* argument = nullptr;
};

/// Reliable, transient-local, keep-last: the writer keeps its last `depth` samples for late and restarted readers, and
/// write() never blocks. Throws Error.
dds_entity_t create_writer(dds_entity_t participant, const dds_topic_descriptor_t& type, const std::string& topic,
                           int depth, const std::string& user_data);
/// Reliable, transient-local, keep-all: the reader receives everything that a writer keeps. Throws Error.
/// `guard`: see ReaderGuard.
dds_entity_t create_member_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, const std::string& user_data,
                                  const ReaderGuard& guard = {});
/// Reliable, volatile, keep-last `depth`: the reader receives nothing that was written before it existed. Throws Error.
dds_entity_t create_command_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                   const std::string& topic, int depth);
/// Best effort, volatile, keep-last `depth`: the reader never delays a writer. Throws Error.
dds_entity_t create_observer_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                    const std::string& topic, int depth);

/// Takes all samples that have arrived and calls `use(message, writer)` for each valid one. `message` (void*) may be
/// changed; `writer` is the publication handle. The loan is returned also if `use` throws.
template <class Use>
void take_all_from(dds_entity_t reader, Use&& use) {
  // Nearly always one sample has arrived. After each take Cyclone clears as many structs as the largest batch that was
  // asked for: with batches of 32, that was up to 0.4 MB for each sample of contacts.
  constexpr std::size_t kBatch = 2;
  for (;;) {
    std::array<void*, kBatch> messages{};
    std::array<dds_sample_info_t, kBatch> infos{};
    const int count = check(dds_take(reader, messages.data(), infos.data(), kBatch, kBatch), "dds_take");
    if (count == 0) return;
    const Loan loan(reader, messages.data(), count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) use(messages[i], infos[i].publication_handle);
    }
    if (count < static_cast<int>(kBatch)) return;
  }
}

/// Makes every text of a message printable, because texts from the network reach terminals and logs.
struct PrintableTexts {
  template <class Info, class Field>
  void operator()(const Info&, Field& field) const {
    visit(field);
  }
  template <std::size_t N>
  static void visit(char (&text)[N]) {
    const auto end = std::find(text, text + N, '\0');
    if (std::any_of(text, end, [](char c) { return c < ' ' || c > '~'; })) set_text(text, printable({text, end}));
  }
  template <class Part>
  static void visit(Part& part) {
    if constexpr (requires { Description<Part>::kName; }) Description<Part>::visit(part, PrintableTexts{});
  }
};

template <class T>
class Writer {
 public:
  Writer() = default;
  Writer(dds_entity_t participant, const std::string& topic, int depth, const std::string& user_data = {})
      : entity_(create_writer(participant, descriptor<T>(), topic, depth, user_data), "dds_create_writer") {}
  /// A writer of a barrier or client topic, with the depth of the table.
  Writer(dds_entity_t participant, const UncountedTopic<T>& topic, const std::string& user_data = {})
      : Writer(participant, topic.name, topic.depth, user_data) {}
  void write(const T& message) const { check(dds_write(entity_.get(), &message), "dds_write"); }
  /// Number of readers that it has matched.
  [[nodiscard]] int readers() const {
    return check(dds_get_matched_subscriptions(entity_.get(), nullptr, 0), "dds_get_matched_subscriptions");
  }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  Entity entity_;
};

template <class T>
class Reader {
 public:
  Reader() = default;
  ~Reader() = default;
  Reader(Reader&&) noexcept = default;
  Reader& operator=(Reader&& other) noexcept {
    entity_ = std::move(other.entity_);  // first: the reader before may call its own passes_ until it is deleted
    passes_ = std::move(other.passes_);
    return *this;
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  static Reader member(dds_entity_t participant, const std::string& topic, const std::string& user_data = {}) {
    return Reader(create_member_reader(participant, descriptor<T>(), topic, user_data));
  }
  /// A reader of commands, with the depth of the table: it does not obey commands from before its start.
  static Reader command(dds_entity_t participant, const UncountedTopic<T>& topic) {
    return Reader(create_command_reader(participant, descriptor<T>(), topic.name, topic.depth));
  }
  static Reader observer(dds_entity_t participant, const std::string& topic, int depth = 1) {
    return Reader(create_observer_reader(participant, descriptor<T>(), topic, depth));
  }
  /// A member's reader whose writers `book` notes. Samples for which `passes(message)` is false cost no memory; DDS
  /// calls it in any thread.
  static Reader guarded(dds_entity_t participant, const UncountedTopic<T>& topic, WriterBook& book,
                        std::function<bool(const T&)> passes = {}) {
    auto kept = std::make_unique<Passes>(std::move(passes));
    ReaderGuard guard{&book};
    if (*kept) {
      guard.passes = [](const void* message, void* own) {
        return (*static_cast<Passes*>(own))(*static_cast<const T*>(message));
      };
      guard.argument = kept.get();
    }
    Reader reader(create_member_reader(participant, descriptor<T>(), topic.name, {}, guard));
    reader.passes_ = std::move(kept);
    return reader;
  }
  template <class Use>
  void take(Use&& use) const {
    take_from([&](const T& message, dds_instance_handle_t) { use(message); });
  }
  /// Calls `use(message, writer)`; `writer` is the publication handle.
  template <class Use>
  void take_from(Use&& use) const {
    take_all_from(entity_.get(), [&](void* message, dds_instance_handle_t writer) {
      PrintableTexts::visit(*static_cast<T*>(message));
      use(*static_cast<const T*>(message), writer);
    });
  }
  /// Number of living writers that it has matched.
  [[nodiscard]] int writers() const {
    return check(dds_get_matched_publications(entity_.get(), nullptr, 0), "dds_get_matched_publications");
  }
  [[nodiscard]] dds_entity_t get() const { return entity_.get(); }

 private:
  using Passes = std::function<bool(const T&)>;
  explicit Reader(dds_entity_t handle) : entity_(handle, "dds_create_reader") {}
  std::unique_ptr<Passes> passes_;  ///< outlives the reader, which calls it
  Entity entity_;
};

using constrictor::set_text;

/// User data of every endpoint that matches this reader or writer.
std::vector<std::string> matched_user_data(dds_entity_t endpoint, bool is_writer);

}  // namespace constrictor::dds
