(* Numbers of a field with functions, their dual numbers, and fractions of polynomials that stand for them.

   Claims are functions over any `ops`. The relation between two of these that all operations keep is kept by each claim: so a
   claim of polynomials, which a computer decides, is one of each field. *)

Require Import ZArith List Bool Lia Ring_polynom InitialRing BinList Field.
Import ListNotations.

(* Functions that aren't rational; the last two are those of the certificate's page. *)
Inductive function := Sqrt | Sin | Cos | Exp | Ln | Stumpff (k : nat) | LogRatio (k : nat).
Definition same_function (f g : function) : bool :=
  match f, g with
  | Sqrt, Sqrt | Sin, Sin | Cos, Cos | Exp, Exp | Ln, Ln => true
  | Stumpff j, Stumpff k | LogRatio j, LogRatio k => Nat.eqb j k
  | _, _ => false
  end.

Record ops := {
  T : Type;
  whole : Z -> T;
  add : T -> T -> T;
  sub : T -> T -> T;
  mul : T -> T -> T;
  div : T -> T -> T;
  opp : T -> T;
  call : function -> T -> T;
  idle : (unit -> T) -> T (* the value, which a check doesn't need *)
}.

(* The derivative of a function. *)
Definition slope (o : ops) (f : function) (x : T o) : T o :=
  let of z := whole o (Z.of_nat z) in
  match f with
  | Sqrt => div o (of 1) (mul o (of 2) (call o Sqrt x))
  | Sin => call o Cos x
  | Cos => opp o (call o Sin x)
  | Exp => call o Exp x
  | Ln => div o (of 1) x
  | Stumpff k => div o (sub o (mul o (of k) (call o (Stumpff (2 + k)) x)) (call o (Stumpff (1 + k)) x)) (of 2)
  | LogRatio k => call o (LogRatio (1 + k)) x
  end.

(* a + b ε with ε² = 0: of a function at x + ε the second part is the derivative. *)
Definition dual (o : ops) : ops := {|
  T := T o * T o;
  whole z := (whole o z, whole o 0);
  add a b := (add o (fst a) (fst b), add o (snd a) (snd b));
  sub a b := (sub o (fst a) (fst b), sub o (snd a) (snd b));
  mul a b := (mul o (fst a) (fst b), add o (mul o (fst a) (snd b)) (mul o (snd a) (fst b)));
  div a b := let q := div o (fst a) (fst b) in (q, div o (sub o (snd a) (mul o q (snd b))) (fst b));
  opp a := (opp o (fst a), opp o (snd a));
  call f a := (call o f (fst a), mul o (slope o f (fst a)) (snd a));
  idle f := (idle o (fun _ => fst (f tt)), idle o (fun _ => snd (f tt)))
|}.

Record related (p q : ops) (R : T p -> T q -> Prop) : Prop := {
  of_whole : forall z, R (whole p z) (whole q z);
  of_add : forall a b x y, R a x -> R b y -> R (add p a b) (add q x y);
  of_sub : forall a b x y, R a x -> R b y -> R (sub p a b) (sub q x y);
  of_mul : forall a b x y, R a x -> R b y -> R (mul p a b) (mul q x y);
  of_div : forall a b x y, R a x -> R b y -> R (div p a b) (div q x y);
  of_opp : forall a x, R a x -> R (opp p a) (opp q x);
  of_call : forall f a x, R a x -> R (call p f a) (call q f x);
  of_idle : forall f g, R (f tt) (g tt) -> R (idle p f) (idle q g)
}.

Definition pair {A B} (R : A -> B -> Prop) (a : A * A) (b : B * B) : Prop := R (fst a) (fst b) /\ R (snd a) (snd b).

Lemma slope_related p q R f a x : related p q R -> R a x -> R (slope p f a) (slope q f x).
Proof. intros [w s t m d n c i] h; destruct f; cbn [slope]; auto 8. Qed.
Lemma dual_related p q R : related p q R -> related (dual p) (dual q) (pair R).
Proof.
  intro r; pose proof (fun f a x => slope_related p q R f a x r) as slopes; destruct r as [w a s m d n c i].
  split; unfold pair; cbn; intros; repeat match goal with H : _ /\ _ |- _ => destruct H end; split; auto 8.
Qed.

(* Polynomials with whole coefficients, of the standard library. *)
Definition poly := Pol Z.
Definition padd := Padd 0%Z Z.add Zeq_bool.
Definition psub := Psub 0%Z Z.add Z.sub Z.opp Zeq_bool.
Definition pmul := Pmul 0%Z 1%Z Z.add Z.mul Zeq_bool.
Definition popp := Popp Z.opp.
Definition peq := Peq Zeq_bool.
Definition px (j : positive) : poly := mk_X 0%Z 1%Z j.
Definition pc (z : Z) : poly := Pc z.
Fixpoint ppow (p : poly) (k : nat) : poly := match k with 0 => pc 1 | S m => pmul p (ppow p m) end.

(* The value of a polynomial at whole numbers, by which a divisor's factors are guessed. *)
Definition at_point (point : list Z) (p : poly) : Z := Pphi 0%Z Z.add Z.mul (fun z => z) point p.

Definition modulo_point (point : list Z) (prime : Z) (p : poly) : Z :=
  Pphi 0%Z (fun a b => Z.modulo (a + b) prime) (fun a b => Z.modulo (a * b) prime) (fun z => Z.modulo z prime) point p.

(* How often a prime divides a number. *)
Fixpoint valuation (fuel : nat) (prime z : Z) : nat :=
  match fuel with
  | 0 => 0
  | S m => if (z =? 0)%Z || negb (Z.modulo z prime =? 0)%Z then 0 else S (valuation m prime (Z.div z prime))
  end.

(* A variable's square as a polynomial, which is put in its place; and q = a + b m for a product m of powers, as a and b. *)
Definition square := ((Z * Mon) * poly)%type.
Definition x_to (i j : positive) : Mon := zmon_pred j (vmon i mon0).
Definition square_of (j : positive) (p : poly) : square := ((1%Z, x_to 2 j), p).
Definition psubst : poly -> list square -> nat -> poly := PSubstL1 0%Z 1%Z Z.add Z.mul Zeq_bool Z.quotrem.
Definition parts_by (m : Mon) (q : poly) : poly * poly := MFactor 0%Z 1%Z Zeq_bool Z.quotrem q 1%Z m.

(* The greatest common divisor of the coefficients. *)
Fixpoint content (p : poly) : Z :=
  match p with Pc z => z | Pinj _ q => content q | PX q _ r => Z.gcd (content q) (content r) end.

(* Exponents of the polynomials below; those that are left out are zero. *)
Definition powers := list nat.
Fixpoint plus_ (d e : powers) : powers := match d, e with [], _ => e | _, [] => d | a :: p, b :: q => a + b :: plus_ p q end.
Fixpoint lack (d e : powers) : powers := match d, e with _, [] => [] | [], _ => e | a :: p, b :: q => b - a :: lack p q end.
Fixpoint under_ (l : list poly) (d : powers) : poly :=
  match l, d with
  | p :: l, 0 :: d => under_ l d
  | p :: l, k :: d => pmul (ppow p k) (under_ l d)
  | _, _ => pc 1
  end.

(* A fraction; or the reason why it isn't known: nobody needs it, or something stands below, or a function isn't known there. *)
Inductive reason := Idle | Below (p : poly) | Call (f : function) (p : poly) (d : powers).
Inductive frac := Known (p : poly) (d : powers) | Unknown (r : reason).

(* What may stand below: polynomials, each a prime number or with a prime that divides its value at the point once, and no other's
   value; variables that are square roots, and their squares; values of functions. *)
Record below := {
  polynomials : list poly;
  point : list Z;
  primes : list Z;
  roots : list (positive * poly);
  known : list (function * frac * frac)
}.
Section Fractions.
Variable l : below.
Definition squares : list square := map (fun r => square_of (fst r) (snd r)) (roots l).
Definition reduced (p : poly) : poly := match roots l with [] => p | _ => psubst p squares 40 end.
Definition lifted (p : poly) (d : powers) : poly :=
  if forallb (Nat.eqb 0) d then p else pmul p (under_ (polynomials l) d).

Definition made (p : poly) (d : powers) : frac :=
  if peq p (pc 0) then Known (pc 0) [] else Known p d.

Definition linear (op : poly -> poly -> poly) (f g : frac) : frac :=
  match f, g with
  | Known p d, Known q e => made (op (lifted p (lack d e)) (lifted q (lack e d))) (plus_ d (lack d e))
  | Unknown r, _ | _, Unknown r => Unknown r
  end.
Definition fmul (f g : frac) : frac :=
  match f, g with
  | Known p d, Known q e => made (reduced (pmul p q)) (plus_ d e)
  | Unknown r, _ | _, Unknown r => Unknown r
  end.
Definition fopp (f : frac) : frac := match f with Known p d => Known (popp p) d | u => u end.
(* A multiplier by which a polynomial has no roots any more. *)
Definition without_roots (q : poly) : poly :=
  fst (fold_left (fun found root =>
    let '(a, b) := parts_by (x_to 1 (fst root)) (snd found) in
    if peq b (pc 0) then found
    else let c := if peq a (pc 0) then px (fst root) else psub a (pmul b (px (fst root))) in
      (reduced (pmul (fst found) c), reduced (pmul (snd found) c)))
  (roots l) (pc 1, q)).
Definition factors (q : poly) : powers :=
  let c := content q in let z := at_point (point l) q in
  map (fun pp : poly * Z => match fst pp with Pc p => valuation 40 p c | _ => valuation 40 (snd pp) z end)
    (combine (polynomials l) (primes l)).
Definition fdiv (f g : frac) : frac :=
  match f, g with
  | Known p d, Known q e =>
      let m := without_roots q in let r := reduced (pmul q m) in
      let s := factors r in let whole_ := under_ (polynomials l) s in
      if peq r whole_ then made (reduced (pmul (lifted p e) m)) (plus_ d s)
      else if peq r (popp whole_) then made (popp (reduced (pmul (lifted p e) m))) (plus_ d s) else Unknown (Below r)
  | Unknown r, _ | _, Unknown r => Unknown r
  end.
Definition alike (f g : frac) : bool :=
  match f, g with Known p d, Known q e => peq (lifted p (lack d e)) (lifted q (lack e d)) | _, _ => false end.
Fixpoint looked_up (f : function) (x : frac) (l : list (function * frac * frac)) : frac :=
  match l with
  | (g, a, v) :: rest => if same_function f g && alike a x then v else looked_up f x rest
  | [] => match x with Known p d => Unknown (Call f p d) | u => u end
  end.
Definition fractions : ops := {|
  T := frac; whole z := Known (pc z) []; add := linear padd; sub := linear psub; mul := fmul; div := fdiv; opp := fopp;
  call f x := looked_up f x (known l);
  idle _ := Unknown Idle
|}.
Definition var (j : positive) : frac := Known (px j) [].
End Fractions.

Section Field.
Variable K : Type.
Variables (k0 k1 : K) (kadd kmul ksub kdiv : K -> K -> K) (kopp kinv : K -> K).
Variable theory : field_theory k0 k1 kadd kmul ksub kopp kdiv kinv (@eq K).
Add Field field_of_K : theory.
Definition phi := gen_phiZ k0 k1 kadd kmul kopp.
Variable apply : function -> K -> K.
Definition numbers : ops := {|
  T := K; whole := phi; add := kadd; sub := ksub; mul := kmul; div := kdiv; opp := kopp; call := apply;
  idle f := f tt
|}.

Variable env : list K.
Definition ring_ : ring_theory k0 k1 kadd kmul ksub kopp eq := F_R theory.
Definition equivalence : RelationClasses.Equivalence (@eq K) := RelationClasses.eq_equivalence.
Definition extension : ring_eq_ext kadd kmul kopp (@eq K) := Eq_ext kadd kmul kopp.
Definition almost := Rth_ARth equivalence extension ring_.
Definition morphism : ring_morph k0 k1 kadd kmul ksub kopp eq 0%Z 1%Z Z.add Z.mul Z.sub Z.opp Zeq_bool phi :=
  gen_phiZ_morph equivalence extension ring_.
Definition ev (p : poly) : K := Pphi k0 kadd kmul phi env p.
Lemma ev_add p q : ev (padd p q) = kadd (ev p) (ev q).
Proof. exact (Padd_ok equivalence extension almost morphism q p env). Qed.
Lemma ev_sub p q : ev (psub p q) = ksub (ev p) (ev q).
Proof. exact (Psub_ok equivalence extension almost morphism q p env). Qed.
Lemma ev_mul p q : ev (pmul p q) = kmul (ev p) (ev q).
Proof. exact (Pmul_ok equivalence extension almost morphism p q env). Qed.
Lemma ev_opp p : ev (popp p) = kopp (ev p).
Proof. exact (Popp_ok equivalence extension almost morphism p env). Qed.
Lemma ev_eq p q : peq p q = true -> ev p = ev q.
Proof. intro e; exact (Peq_ok equivalence extension morphism p q e env). Qed.
Lemma ev_x j : ev (px j) = BinList.nth k0 j env.
Proof. symmetry; exact (mkX_ok equivalence extension almost morphism j env). Qed.
Definition power : power_theory k1 kmul eq (fun n : N => n) (pow_N k1 kmul) := pow_N_th k1 kmul equivalence.
Lemma Mphi_x j : Mphi k0 k1 kmul env (x_to 2 j) = kmul (BinList.nth k0 j env) (BinList.nth k0 j env).
Proof. rewrite <- ev_x; destruct j; cbn; unfold phi; cbn; ring. Qed.
Lemma ev_psubst n p s : Forall (fun q => Mphi k0 k1 kmul env (snd (fst q)) = ev (snd q) /\ fst (fst q) = 1%Z) s -> ev (psubst p s n) = ev p.
Proof.
  intro h; symmetry; apply (PSubstL1_ok equivalence extension almost morphism (Ztriv_div_th equivalence phi)).
  induction h as [| [[z m] q] s [e o] _ IH]; cbn; auto; split; auto; cbn in e, o; subst z; rewrite e; unfold phi, ev; cbn; ring.
Qed.
Lemma ev_0 : ev (pc 0) = k0. Proof. reflexivity. Qed.
Lemma ev_1 : ev (pc 1) = k1. Proof. reflexivity. Qed.

Lemma product a b : a <> k0 -> b <> k0 -> kmul a b <> k0.
Proof. intros ha hb z; apply hb; transitivity (kmul (kinv a) (kmul a b)); [field; auto | rewrite z; ring]. Qed.
Lemma cancel x y d : d <> k0 -> kmul x d = kmul y d -> x = y.
Proof. intros hd e; transitivity (kmul (kinv d) (kmul x d)); [field; auto | rewrite e; field; auto]. Qed.

Variable l : below.
Definition under (d : powers) : K := ev (under_ (polynomials l) d).
Lemma ppow_add p a b : ev (ppow p (a + b)) = kmul (ev (ppow p a)) (ev (ppow p b)).
Proof. induction a; simpl; [rewrite ev_1; ring | rewrite !ev_mul, IHa; ring]. Qed.
Lemma step_ p q a d : ev (under_ (p :: q) (a :: d)) = kmul (ev (ppow p a)) (ev (under_ q d)).
Proof. destruct a; simpl; [rewrite ev_1; ring | rewrite !ev_mul; ring]. Qed.
Lemma nothing q : ev (under_ q []) = k1. Proof. destruct q; reflexivity. Qed.
Definition lawful (r : positive * poly) : Prop := let x := BinList.nth k0 (fst r) env in kmul x x = ev (snd r).
Hypothesis squared : Forall lawful (roots l).
Lemma ev_reduced p : ev (reduced l p) = ev p.
Proof.
  unfold reduced; destruct (roots l) in |- *; auto; apply ev_psubst.
  unfold squares; rewrite Forall_map; eapply Forall_impl; [| exact squared].
  intros [j q] h; cbn [square_of fst snd]; split; auto; rewrite Mphi_x; exact h.
Qed.
Lemma under_plus d e : under (plus_ d e) = kmul (under d) (under e).
Proof.
  unfold under; revert d e; induction (polynomials l) as [| p q IH]; intros d e.
  - destruct d, e; simpl; rewrite ev_1; ring.
  - destruct d as [| a d], e as [| b e]; cbn [plus_]; rewrite ?step_, ?nothing; try ring.
    rewrite ppow_add, IH; ring.
Qed.
Lemma lack_both d : forall e, plus_ d (lack d e) = plus_ e (lack e d).
Proof.
  induction d as [| a d IH]; intros [| b e]; simpl; auto.
  f_equal; [lia | apply IH].
Qed.
Hypothesis sound : Forall (fun p => ev p <> k0) (polynomials l).
Lemma under_not d : under d <> k0.
Proof.
  unfold under; revert d; generalize sound; clear sound; intro given.
  induction given as [| p q hp _ IH]; intros [| a d]; try exact (F_1_neq_0 theory).
  rewrite step_; apply product; [| apply IH].
  induction a; simpl; [exact (F_1_neq_0 theory) | rewrite ev_mul; apply product; auto].
Qed.

(* A fraction stands for a number, and what isn't known for any. *)
Definition means (f : frac) (x : K) : Prop := match f with Known p d => ev p = kmul x (under d) | Unknown _ => True end.
Lemma zero_powers d : forallb (Nat.eqb 0) d = true -> under d = k1.
Proof.
  clear sound; unfold under; revert d; induction (polynomials l) as [| p q IH]; intros [| a d]; try reflexivity.
  destruct a; [exact (IH d) | discriminate].
Qed.
Lemma ev_lifted p d : ev (lifted l p d) = kmul (ev p) (under d).
Proof.
  unfold lifted; destruct (forallb _ d) eqn:z; [rewrite (zero_powers d z); ring | apply ev_mul].
Qed.
Lemma means_made p d x : ev p = kmul x (under d) -> means (made p d) x.
Proof.
  unfold made; destruct (peq p (pc 0)) eqn:z; [| exact (fun h => h)].
  intro h; apply ev_eq in z; change (ev p = k0) in z; change (k0 = kmul x (ev (under_ (polynomials l) []))).
  rewrite nothing; apply (cancel _ _ (under d)); [apply under_not |].
  transitivity k0; [ring |]; transitivity (ev p); [exact (eq_sym z) | rewrite h; ring].
Qed.
Lemma linear_ok op (kop : K -> K -> K) f g x y :
  (forall p q, ev (op p q) = kop (ev p) (ev q)) -> (forall a b c, kmul (kop a b) c = kop (kmul a c) (kmul b c)) ->
  means f x -> means g y -> means (linear l op f g) (kop x y).
Proof.
  intros ok spread; destruct f as [p d |], g as [q e |]; cbn [linear]; unfold means at 1 2; auto; try (cbn; auto; fail).
  intros hp hq; apply means_made; rewrite ok, !ev_lifted, hp, hq, spread; apply f_equal2.
  - rewrite under_plus; ring.
  - rewrite lack_both, under_plus; ring.
Qed.
Lemma mul_ok f g x y : means f x -> means g y -> means (fmul l f g) (kmul x y).
Proof.
  destruct f as [p d |], g as [q e |]; cbn [fmul]; unfold means at 1 2; try (cbn; auto; fail).
  intros hp hq; apply means_made; rewrite ev_reduced, ev_mul, under_plus, hp, hq; ring.
Qed.
Lemma opp_ok f x : means f x -> means (fopp f) (kopp x).
Proof. destruct f as [p d |]; cbn; auto; intro hp; rewrite ev_opp, hp; ring. Qed.
Lemma div_ok f g x y : means f x -> means g y -> means (fdiv l f g) (kdiv x y).
Proof.
  destruct f as [p d |], g as [q e |]; cbn [fdiv]; unfold means at 1 2; try (cbn; auto; fail).
  intros hp hq; set (m := without_roots l q); set (r := reduced l (pmul q m)); set (s := factors l r); cbn zeta.
  assert (hr : ev r = kmul (kmul y (under e)) (ev m)) by (unfold r; rewrite ev_reduced, ev_mul, hq; reflexivity).
  destruct (peq r _) eqn:z; [| destruct (peq r (popp _)) eqn:n; [| cbn; auto]].
  - apply ev_eq in z; fold (under s) in z; apply means_made.
    assert (y <> k0) by (intro w; apply (under_not s); rewrite <- z, hr, w; ring).
    rewrite ev_reduced, ev_mul, ev_lifted, under_plus, hp, <- z, hr; field; auto.
  - apply ev_eq in n; rewrite ev_opp in n; fold (under s) in n; apply means_made.
    assert (m_ : under s = kopp (kmul (kmul y (under e)) (ev m))) by (rewrite <- hr, n; ring).
    assert (y <> k0) by (intro w; apply (under_not s); rewrite m_, w; ring).
    rewrite ev_opp, ev_reduced, ev_mul, ev_lifted, under_plus, hp, m_; field; auto.
Qed.
Lemma alike_ok f g x y : means f x -> means g y -> alike l f g = true -> x = y.
Proof.
  destruct f as [p d |], g as [q e |]; cbn; try discriminate; intros hp hq s; apply ev_eq in s.
  rewrite !ev_lifted, hp, hq in s; apply (cancel x y (under (plus_ d (lack d e)))); [apply under_not |].
  transitivity (kmul (kmul x (under d)) (under (lack d e))); [rewrite under_plus; ring |].
  rewrite s, lack_both, under_plus; ring.
Qed.
Definition true_call (c : function * frac * frac) : Prop := let '(f, a, v) := c in exists x, means a x /\ means v (apply f x).
Hypothesis called : Forall true_call (known l).
Lemma same_function_ok f g : same_function f g = true -> f = g.
Proof. destruct f, g; cbn; try discriminate; auto; intro e; apply Nat.eqb_eq in e; subst; auto. Qed.
Lemma call_ok f a x : means a x -> means (looked_up l f a (known l)) (apply f x).
Proof.
  intro h; induction called as [| [[g b] v] rest [y [hb hv]] _ IH]; cbn [looked_up]; [destruct a; exact I |].
  destruct (same_function f g && alike l b a) eqn:e; [| exact (IH (Forall_inv_tail called))]; apply andb_true_iff in e; destruct e as [e s].
  apply same_function_ok in e; rewrite e, <- (alike_ok _ _ _ _ hb h s); exact hv.
Qed.
Lemma fractions_related : related (fractions l) numbers means.
Proof.
  split.
  - intro z; cbn; unfold under; rewrite nothing; change (ev (pc z)) with (phi z); ring.
  - intros; apply (linear_ok padd kadd); auto; [exact ev_add | intros; ring].
  - intros; apply (linear_ok psub ksub); auto; [exact ev_sub | intros; ring].
  - exact mul_ok.
  - exact div_ok.
  - exact opp_ok.
  - exact call_ok.
  - intros; exact I.
Qed.
Lemma var_ok j : means (var j) (BinList.nth k0 j env).
Proof. cbn -[px]; rewrite ev_x; unfold under; rewrite nothing; ring. Qed.
Lemma all_alike a x : Forall2 means a x -> forall b y, Forall2 means b y ->
  length a = length b -> forallb (fun p => alike l (fst p) (snd p)) (combine a b) = true -> x = y.
Proof.
  induction 1 as [| f u a x hf _ IH]; intros b y [| g v b' y' hg hb]; simpl; try discriminate; auto.
  rewrite andb_true_iff; intros n [s r]; f_equal; [exact (alike_ok _ _ _ _ hf hg s) | apply (IH b'); auto].
Qed.
End Field.
