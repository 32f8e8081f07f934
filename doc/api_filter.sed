# What Doxygen shall read besides comments with three strokes: the comment that opens a header, and those behind a member.
1s|^// |/// @file\n/// |
2,/^#pragma/s|^//|///|
/^#pragma/,$s|([;,{}]) +// |\1  ///< |
