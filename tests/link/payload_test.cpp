// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <gtest/gtest.h>

namespace glidar::link {
namespace {

TEST(VectorPool, PassesBytesWithoutACopyAndReusesTheirMemory) {
  VectorPool pool;
  std::vector<std::byte> bytes(1000, std::byte{7});
  const std::byte* memory = bytes.data();
  {
    const Payload payload = pool.take(bytes);
    EXPECT_EQ(payload.memory.get(), memory);
    EXPECT_EQ(payload.size, 1000U);
    EXPECT_EQ(payload.bytes()[999], std::byte{7});
    EXPECT_TRUE(bytes.empty());  // nothing was sent yet
  }
  std::vector<std::byte> next(900, std::byte{8});
  const Payload payload = pool.take(next);
  EXPECT_EQ(payload.size, 900U);
  EXPECT_EQ(next.data(), memory);
}

TEST(VectorPool, PayloadsOutliveThePool) {
  Payload payload;
  {
    VectorPool pool;
    std::vector<std::byte> bytes(10, std::byte{3});
    payload = pool.take(bytes);
  }
  EXPECT_EQ(payload.bytes()[9], std::byte{3});
}

}  // namespace
}  // namespace glidar::link
