#pragma once

#include <string>

namespace visavis {

/// Moves this process (call it before any thread starts) into a network of its own, with the
/// addresses 127.0.0.1 to 127.0.0.3 and a multicast route: cameras of tests that run at the same
/// time do not meet. Where the system does not allow that, the host's own network serves if it has
/// these addresses. @return empty, or why a test that needs them must be skipped.
std::string EnterPrivateNetwork();

}  // namespace visavis
