#pragma once
// Asks a running server how it is, for container health checks without curl.

#include <string>

namespace toile {

/// The body of GET /healthz; `well` tells whether its status was 200. Empty when nobody answered in five seconds.
std::string ask_health(const std::string& host, int port, bool& well);

}  // namespace toile
