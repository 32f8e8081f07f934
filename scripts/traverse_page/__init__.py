"""The page of a results file: data collected by Python; HTML, CSS and JavaScript that show them in a browser."""
