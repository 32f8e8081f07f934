// Standard output that may fail - a full disk, a reader that has gone - without harm to the run and its results.
#pragma once

namespace traverse::app {

/// Before anything is written or opened: from now on writing to stdout always succeeds, and what could not be written
/// is remembered. Standard streams that are closed become /dev/null, so that no file of ours takes their place.
void guard_standard_output();

/// Writes what is still buffered. The errno of what was lost; 0 when nothing was.
int lost_output();

}  // namespace traverse::app
