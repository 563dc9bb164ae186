#pragma once

#include <string>

namespace visavis {

/// Largest packet [bytes, IP header and all] of the interface that has this host's @p address
/// (dotted, or one within the interface's network); 1500, Ethernet's, where there is none.
int InterfaceMtu(const std::string& address);

}  // namespace visavis
