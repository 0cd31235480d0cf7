"""Studies: plans of many analyses, the processes that do them, and the ledger of outcomes."""
