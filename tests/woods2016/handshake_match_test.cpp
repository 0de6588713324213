// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/woods2016/protocol.hpp>

#include <gtest/gtest.h>

namespace glidar::woods2016 {
namespace {

TEST(HandshakeMatch, NothingIsPendingAtFirst) {
  const HandshakeMatch match;
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 0U);
}

TEST(HandshakeMatch, ASubscriptionMayArriveBeforeOrAfterTheHandshake) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 0U);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
  match.set_subscribers(2);
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 2U);
}

TEST(HandshakeMatch, EachSubscriberMatchesOneHandshake) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.add_handshake();
  match.add_handshake();
  match.set_subscribers(1);
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, ASubscriberThatLeftStaysMatched) {
  HandshakeMatch match;
  match.add_handshake();
  match.set_subscribers(1);
  match.set_subscribers(0);
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 1U);
}

TEST(HandshakeMatch, AReturningSubscriberIsNotMatchedWithTheNextPeer) {
  HandshakeMatch match;
  match.add_handshake();
  match.set_subscribers(1);
  match.set_subscribers(0);
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, ASubscriberThatLeftBeforeItsHandshakeIsExpectedAgain) {
  HandshakeMatch match;
  match.set_subscribers(1);
  match.set_subscribers(0);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
}

TEST(HandshakeMatch, LateSubscriptionsMatchTheOldHandshakes) {
  HandshakeMatch match;
  match.add_handshake();
  match.stop_waiting();
  EXPECT_EQ(match.pending(), 0U);
  EXPECT_EQ(match.matched(), 0U);
  match.set_subscribers(1);
  match.add_handshake();
  EXPECT_EQ(match.pending(), 1U);
  match.set_subscribers(2);
  EXPECT_EQ(match.pending(), 0U);
}

}  // namespace
}  // namespace glidar::woods2016
