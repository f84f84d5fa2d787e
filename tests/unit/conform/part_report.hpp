// What the tests of all parts expect of a report.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "conform/report.hpp"
#include "support/named_fault.hpp"

namespace constrictor::testing {

inline std::string text_of(const conform::Report& report) {
  std::string text;
  for (const auto& check : report.checks()) text += conform::text_of(check) + "\n";
  return text;
}

/// The first check that failed is the one that names the fault, and every check has a result.
inline void expect_named(const conform::Report& report, const NamedFault& fault) {
  EXPECT_FALSE(report.conforms());
  const auto first = std::find_if(report.checks().begin(), report.checks().end(), [](const conform::Check& check) {
    return check.verdict == conform::Verdict::kFailed;
  });
  ASSERT_NE(first, report.checks().end()) << text_of(report);
  EXPECT_EQ(first->name, fault.check) << text_of(report);
  EXPECT_NE(first->found.find(fault.found), std::string::npos) << first->found;
  EXPECT_FALSE(first->todo.empty());
  EXPECT_EQ(report.count(conform::Verdict::kNotChecked), 0u) << text_of(report);
}

}  // namespace constrictor::testing
