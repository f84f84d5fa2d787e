// A short list in place, for what perception collects in each image: it needs no memory of the heap.
#pragma once

#include <array>
#include <cstddef>

namespace constrictor::perception {

/// At most `Most` values.
template <class T, std::size_t Most>
class Few {
 public:
  void push_back(const T& value) { values_.at(size_++) = value; }
  void pop_back() { --size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == Most; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return values_.at(i); }
  [[nodiscard]] const T& front() const { return values_.front(); }
  [[nodiscard]] const T& back() const { return values_.at(size_ - 1); }
  [[nodiscard]] T* begin() { return values_.data(); }
  [[nodiscard]] T* end() { return values_.data() + size_; }
  [[nodiscard]] const T* begin() const { return values_.data(); }
  [[nodiscard]] const T* end() const { return values_.data() + size_; }

 private:
  std::array<T, Most> values_{};
  std::size_t size_ = 0;
};

}  // namespace constrictor::perception
