// Owners of entities and QoS of Cyclone DDS's C API.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace constrictor::dds {

/// A DDS call failed; what() has the call and Cyclone's text for the return code.
class Error : public std::runtime_error {
 public:
  Error(const std::string& call, dds_return_t code)
      : std::runtime_error("DDS: " + call + ": " + dds_strretcode(-code)) {}
};

/// Throws on a negative return code.
inline dds_return_t check(dds_return_t code, const char* call) {
  if (code < 0) throw Error(call, code);
  return code;
}

/// Owns one DDS entity. Deleting it also deletes the entities that were created under it.
class Entity {
 public:
  Entity() = default;
  Entity(dds_entity_t handle, const char* call) : handle_(check(handle, call)) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      reset();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() { reset(); }

  [[nodiscard]] dds_entity_t get() const { return handle_; }
  explicit operator bool() const { return handle_ > 0; }
  void reset() {
    if (handle_ > 0) dds_delete(handle_);
    handle_ = 0;
  }

 private:
  dds_entity_t handle_ = 0;
};

/// Returns the samples that a reader has lent, also if their use throws.
struct Loan {
  Loan(dds_entity_t from, void** lent, int number) : reader(from), samples(lent), count(number) {}
  ~Loan() {
    if (count > 0) dds_return_loan(reader, samples, count);
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;
  dds_entity_t reader;
  void** samples;
  int count;
};

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

inline Qos make_qos() { return Qos(dds_create_qos(), dds_delete_qos); }

}  // namespace constrictor::dds
