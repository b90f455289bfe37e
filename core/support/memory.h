#pragma once

namespace imunoise {

/// For a process that computes and ends: what it frees it keeps, for it soon asks for as much
/// again, and fresh pages cost an analysis of long series a fifth of its time. Arrays of more than
/// two million numbers go back all the same: of them a process would keep more than it uses. To be
/// called before there are threads.
void keep_freed_memory();

}  // namespace imunoise
