"""Publication of assignments by staff: assignment of variants, dates, and extensions."""
