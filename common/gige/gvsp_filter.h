#pragma once

#include <string>

namespace visavis {

/// Lets only well-made GVSP packets of one camera reach a stream's socket of this process: leaders
/// and trailers of images, and data, long enough for their headers. (Aravis 0.8.26 takes any
/// sender's packets, and reads and writes beyond its memory for senseless ones.)
/// @param local_port UDP port that the socket is bound to @param camera_address dotted
/// @return how many sockets were found and filtered
int FilterStreamSocket(int local_port, const std::string& camera_address);

}  // namespace visavis
