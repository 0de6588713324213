// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/log_sink.hpp>

#include <glidar/core/excerpt.hpp>

#include <dds/ddsrt/log.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <string_view>
#include <vector>

namespace glidar::dds {
namespace {

struct Logs {
  std::mutex mutex;
  std::vector<link::ErrorLog*> all;
};

/// Of the process, as the destination in Cyclone DDS.
Logs& logs() {
  static Logs instance;
  return instance;
}

void forward(void* /*unused*/, const dds_log_data_t* data) {
  if ((data->priority & (DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING)) == 0U) return;
  std::string_view text(data->message, data->size);
  while (text.ends_with('\n') || text.ends_with('\0')) text.remove_suffix(1);
  try {
    const std::lock_guard lock(logs().mutex);
    for (link::ErrorLog* log : logs().all) log->report("Cyclone DDS", excerpt(text));
  } catch (const std::exception&) {  // out of memory: the caller is in C
    return;
  }
}

}  // namespace

LogSink::LogSink(link::ErrorLog& log) : log_(log) {
  {
    const std::lock_guard lock(logs().mutex);
    logs().all.push_back(&log_);
  }
  dds_set_log_sink(forward, nullptr);  // waits for calls of forward()
}

LogSink::~LogSink() {
  const std::lock_guard lock(logs().mutex);
  std::vector<link::ErrorLog*>& all = logs().all;
  all.erase(std::ranges::find(all, &log_));
}

}  // namespace glidar::dds
