// Says where a process was when it was aborted.
#pragma once

namespace constrictor::dds {

/// From now on abort() first writes the calls that led to it to stderr. Cyclone DDS aborts the process without a word
/// when it finds itself in a state that cannot be; these lines are then all that there is to find the reason. Does
/// nothing if the program handles SIGABRT itself.
void say_where_aborted();

}  // namespace constrictor::dds
