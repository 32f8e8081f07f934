"""The report of results files: PDF on A4 and XLSX."""
