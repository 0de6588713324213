// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <gtest/gtest.h>

namespace glidar::link {
namespace {

TEST(PayloadPool, PassesVectorsWithoutACopyAndReusesTheirMemory) {
  PayloadPool pool;
  std::vector<std::byte> bytes(100'000, std::byte{7});
  const std::byte* memory = bytes.data();
  {
    const Payload payload = pool.take(bytes);
    EXPECT_EQ(payload.memory.get(), memory);
    EXPECT_EQ(payload.size, 100'000U);
    EXPECT_EQ(payload.bytes()[99'999], std::byte{7});
    EXPECT_TRUE(bytes.empty());  // nothing was sent yet
  }
  std::vector<std::byte> next(90'000, std::byte{8});
  const Payload payload = pool.take(next);
  EXPECT_EQ(payload.size, 90'000U);
  EXPECT_EQ(next.data(), memory);
}

TEST(PayloadPool, ReusesTheMemoryOfSentMessages) {
  PayloadPool pool;
  const std::byte* memory = nullptr;
  {
    const Payload payload = pool.take(100'000);
    EXPECT_EQ(payload.bytes().size(), 100'000U);
    memory = payload.memory.get();
  }
  const Payload again = pool.take(80'000);
  EXPECT_EQ(again.memory.get(), memory);
  EXPECT_EQ(again.bytes().size(), 80'000U);
  EXPECT_NE(pool.take(80'000).memory.get(), memory);  // it is in use
}

TEST(PayloadPool, PayloadsOutliveThePool) {
  Payload payload;
  {
    PayloadPool pool;
    std::vector<std::byte> bytes(100'000, std::byte{3});
    payload = pool.take(bytes);
  }
  EXPECT_EQ(payload.bytes()[9], std::byte{3});
}

}  // namespace
}  // namespace glidar::link
