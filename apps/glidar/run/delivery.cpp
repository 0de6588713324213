// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/delivery.hpp>

#include <utility>

namespace glidar::app {

Delivery::Delivery(std::function<void(const MeasuredFrame&)> deliver, std::function<void()> idle,
                   std::function<void()> failed, std::chrono::milliseconds idle_interval)
    : deliver_(std::move(deliver)),
      idle_(std::move(idle)),
      failed_(std::move(failed)),
      idle_interval_(idle_interval),
      thread_([this] { run(); }) {}

Delivery::~Delivery() {
  join();
}

MeasuredFrame& Delivery::next_slot() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return filled_ - delivered_ < slots_.size() || failure_; });
  rethrow();
  return slots_[filled_ % slots_.size()];
}

void Delivery::submit() {
  {
    const std::lock_guard lock(mutex_);
    ++filled_;
  }
  changed_.notify_all();
}

void Delivery::finish() {
  join();
  rethrow();
}

void Delivery::join() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Delivery::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Delivery::run() {
  std::unique_lock lock(mutex_);
  const auto is_due = [this] { return delivered_ < filled_ || is_ending_; };
  try {
    for (;;) {
      changed_.wait_for(lock, idle_interval_, is_due);
      const bool has_frame = delivered_ < filled_;
      if (!has_frame && is_ending_) return;
      lock.unlock();
      if (has_frame) deliver_(slots_[delivered_ % slots_.size()]);
      idle_();
      lock.lock();
      if (has_frame) ++delivered_;
      changed_.notify_all();
    }
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
    changed_.notify_all();
    failed_();
  }
}

}  // namespace glidar::app
