// A program that is not part of the run. It publishes types of its own, or causes one of the faults that `constrictor
// doctor` finds.
//   foreign_talker DOMAIN final|appendable|untyped|silent_qos|other_idl|plant
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "foreign.h"
#include "runtime/wire.hpp"

namespace {

using namespace constrictor;
using namespace std::chrono_literals;

volatile std::sig_atomic_t g_stop = 0;

/// The same type without its description (XTypes). Some DDS vendors and versions publish their types so.
dds_topic_descriptor_t undescribed(const dds_topic_descriptor_t& type) {
  return {type.m_size,  type.m_align,    type.m_flagset & ~DDS_TOPIC_XTYPES_METADATA,
          type.m_nkeys, type.m_typename, type.m_keys,
          type.m_nops,  type.m_ops,      type.m_meta,
          {nullptr, 0}, {nullptr, 0},    type.restrict_data_representation};
}

template <class Fill>
void talk(dds_entity_t participant, const dds_topic_descriptor_t& type, const char* topic, Fill&& write) {
  const dds::Entity entity(dds_create_topic(participant, &type, topic, nullptr, nullptr), "dds_create_topic");
  const dds::Entity writer(dds_create_writer(participant, entity.get(), nullptr, nullptr), "dds_create_writer");
  std::puts("talking");
  std::fflush(stdout);
  for (int count = 1; !g_stop; ++count) {
    write(writer.get(), count);
    std::this_thread::sleep_for(10ms);
  }
}

void weather(dds_entity_t writer, int count) {
  foreign_Gust gusts[2] = {{12.5, 3}, {20.25, 5}};
  char first[] = "windy";
  char second[] = "";
  char* remarks[2] = {first, second};
  char station[] = "Trondheim";
  char text[] = "drizzle";
  foreign_Weather message{};
  message.station = station;
  message.count = static_cast<std::uint32_t>(count);
  message.flag = 7;
  message.temperature = -3.5;
  for (int i = 0; i < 6; ++i) message.grid[i / 3][i % 3] = static_cast<float>(i) * 0.5f;
  message.gusts = {2, 2, gusts, false};
  message.remarks = {2, 2, remarks, false};
  message.sky = foreign_RAIN;
  message.reading._d = 2;
  message.reading._u.text = text;
  message.night = true;
  message.when = -1234567890123;
  dds_write(writer, &message);
}

void tide(dds_entity_t writer, int count) {
  foreign_Gust gusts[1] = {{1.5, 2}};
  foreign_Tide message{};
  message.flag = 9;
  message.level = 2.75;
  message.gusts = {1, 1, gusts, false};
  message.count = count;
  dds_write(writer, &message);
}

/// Creates a best-effort writer and a reliable reader of one topic: they never match.
void silent_qos(dds_entity_t participant) {
  const dds::Entity topic(dds_create_topic(participant, &foreign_Tide_desc, "tide", nullptr, nullptr),
                          "dds_create_topic");
  const dds::Qos wants = dds::make_qos();
  dds_qset_reliability(wants.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  const dds::Qos offers = dds::make_qos();
  dds_qset_reliability(offers.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  const dds::Entity reader(dds_create_reader(participant, topic.get(), wants.get(), nullptr), "dds_create_reader");
  const dds::Entity writer(dds_create_writer(participant, topic.get(), offers.get(), nullptr), "dds_create_writer");
  std::puts("talking");
  std::fflush(stdout);
  while (!g_stop) std::this_thread::sleep_for(10ms);
}

/// Publishes the Hello of a member of another version of this project.
void other_idl(dds_entity_t participant) {
  const dds::Writer<msg::Hello> writer(participant, barrier_topics::kHello, 8);
  msg::Hello hello{};
  dds::set_text(hello.component, "guidance");
  dds::set_text(hello.idl_hash, std::string(64, 'b'));
  dds::set_text(hello.version, "0.0.1");
  dds::set_text(hello.host, "elsewhere");
  hello.incarnation = hello.period_ticks = 1;
  writer.write(hello);
  std::puts("talking");
  std::fflush(stdout);
  while (!g_stop) std::this_thread::sleep_for(10ms);
}

/// Creates the writer of a plant without checking whether the domain already has a plant.
void plant(dds_entity_t participant) {
  const dds::Writer<msg::Tick> writer(participant, barrier_topics::kTick, barrier_topics::kTick.depth);
  std::puts("talking");
  std::fflush(stdout);
  while (!g_stop) std::this_thread::sleep_for(10ms);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  const dds::Domain domain(static_cast<std::uint32_t>(std::stoul(argv[1])));
  const std::string mode = argv[2];
  if (mode == "final") talk(domain.participant(), foreign_Weather_desc, "weather", weather);
  else if (mode == "untyped") talk(domain.participant(), undescribed(foreign_Weather_desc), "weather", weather);
  else if (mode == "appendable") talk(domain.participant(), foreign_Tide_desc, "tide", tide);
  else if (mode == "silent_qos") silent_qos(domain.participant());
  else if (mode == "other_idl") other_idl(domain.participant());
  else if (mode == "plant") plant(domain.participant());
  else return 64;
  return 0;
}
