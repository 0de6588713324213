// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

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

namespace {

std::shared_ptr<PointCloud> cloud_of(CloudPool& pool, std::size_t bytes) {
  std::shared_ptr<PointCloud> cloud = pool.take();
  cloud->columns = {{"row", {"row"}, std::vector<std::uint8_t>(bytes)}};
  return cloud;
}

TEST(CloudPool, ReusesTheMemoryOfAReleasedCloud) {
  CloudPool pool;
  std::shared_ptr<PointCloud> cloud = cloud_of(pool, 1000);
  const PointCloud* const first = cloud.get();
  cloud.reset();
  EXPECT_GE(pool.kept_bytes(), 1000U);
  cloud = pool.take();
  EXPECT_EQ(cloud.get(), first);
  EXPECT_EQ(pool.kept_bytes(), 0U);
}

TEST(CloudPool, KeepsLittleMemory) {
  CloudPool pool;
  constexpr std::size_t kQuarter_bytes = CloudPool::kMaxKept_bytes / 4;
  std::vector<std::shared_ptr<PointCloud>> clouds;
  for (int i = 0; i < 20; ++i) clouds.push_back(cloud_of(pool, kQuarter_bytes));
  clouds.clear();
  EXPECT_LE(pool.kept_bytes(), CloudPool::kMaxKept_bytes);
  EXPECT_GE(pool.kept_bytes(), 2 * kQuarter_bytes);
}

TEST(CloudPool, KeepsOneCloudThatIsLarger) {
  CloudPool pool;
  auto first = cloud_of(pool, 2 * CloudPool::kMaxKept_bytes);
  auto second = cloud_of(pool, 2 * CloudPool::kMaxKept_bytes);
  first.reset();
  second.reset();
  EXPECT_GE(pool.kept_bytes(), 2 * CloudPool::kMaxKept_bytes);
  EXPECT_LT(pool.kept_bytes(), 3 * CloudPool::kMaxKept_bytes);
}

}  // namespace
}  // namespace glidar::link
