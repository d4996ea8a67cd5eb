// A method's page.

import { offerCopies } from "../lib/copy.js";

offerCopies(document);
