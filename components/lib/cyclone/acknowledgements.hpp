// Waits until what a process has written has arrived, for the end of processes whose readers may be dead.
#pragma once

#include <dds/dds.h>

#include <functional>

namespace constrictor::dds {

/// For a domain whose processes call wait_for_acknowledgements() before they end: Cyclone DDS does not wait when a
/// writer is deleted. By default, each writer waits for up to a second for readers that do not acknowledge its samples,
/// one writer after the other.
inline constexpr const char* kNoLinger =
    "<CycloneDDS><Domain><Internal><WriterLingerDuration>0s</WriterLingerDuration></Internal></Domain></CycloneDDS>";

/// Waits until all readers have acknowledged all samples of all writers of `participant`: at most `bound_ns` for all
/// writers together, and only while `give_up` returns false; it is asked about every 10 ms. A reader whose process was
/// killed or stopped counts until its lease of 10 s lapses. Returns whether everything has been acknowledged. Throws
/// Error if there is no such participant.
bool wait_for_acknowledgements(dds_entity_t participant, dds_duration_t bound_ns,
                               const std::function<bool()>& give_up = {});

}  // namespace constrictor::dds
