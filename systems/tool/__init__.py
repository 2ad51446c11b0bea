"""Systems of the tool and of the coupling between handle and tool."""
