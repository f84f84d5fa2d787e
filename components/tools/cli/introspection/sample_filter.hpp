// Expressions on the fields of a sample, for `topic echo --filter`. Pure.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

namespace constrictor::cli {

/// The expression cannot be understood, or it does not fit the sample. The message says where and what is accepted.
class FilterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Comparisons (== != < <= > >=) of fields with numbers, texts or other fields, joined by `and`, `or`, `not` and
/// parentheses:
///   event == line_lost and header.tick > 500
///   blobs.*.colour == green          true if one of the elements is
///   visible and not offset_m == null    null: NaN
/// A text of several words stands in quotes. An index that a list does not have makes its comparison false.
class SampleFilter {
 public:
  struct Node;
  /// Throws FilterError.
  explicit SampleFilter(const std::string& expression);
  ~SampleFilter();
  /// Whether a sample fulfils the expression. Throws FilterError if it has no field of a name.
  [[nodiscard]] bool accepts(const nlohmann::ordered_json& sample) const;

 private:
  std::unique_ptr<const Node> root_;
};

}  // namespace constrictor::cli
