//! What refinement in any dimension shares: the worst-first queue, the budget, the counters and the reason to stop.
