(* Numbers of a field, their dual numbers, and fractions of polynomials that stand for them.

   Claims are functions over any `ops`. The relation between two of these that all operations keep is kept by each claim: so a
   claim of polynomials, which a computer decides, is one of each field. *)

Require Import ZArith List Bool Lia Ring_polynom InitialRing BinList Field.
Import ListNotations.

Record ops := {
  T : Type;
  whole : Z -> T;
  add : T -> T -> T;
  sub : T -> T -> T;
  mul : T -> T -> T;
  div : T -> T -> T;
  opp : T -> T;
  idle : (unit -> T) -> T (* the value, which a check doesn't need *)
}.

(* a + b ε with ε² = 0: of a function at x + ε the second part is the derivative. *)
Definition dual (o : ops) : ops := {|
  T := T o * T o;
  whole z := (whole o z, whole o 0);
  add a b := (add o (fst a) (fst b), add o (snd a) (snd b));
  sub a b := (sub o (fst a) (fst b), sub o (snd a) (snd b));
  mul a b := (mul o (fst a) (fst b), add o (mul o (fst a) (snd b)) (mul o (snd a) (fst b)));
  div a b := let q := div o (fst a) (fst b) in (q, div o (sub o (snd a) (mul o q (snd b))) (fst b));
  opp a := (opp o (fst a), opp o (snd a));
  idle f := (idle o (fun _ => fst (f tt)), idle o (fun _ => snd (f tt)))
|}.

Record related (p q : ops) (R : T p -> T q -> Prop) : Prop := {
  of_whole : forall z, R (whole p z) (whole q z);
  of_add : forall a b x y, R a x -> R b y -> R (add p a b) (add q x y);
  of_sub : forall a b x y, R a x -> R b y -> R (sub p a b) (sub q x y);
  of_mul : forall a b x y, R a x -> R b y -> R (mul p a b) (mul q x y);
  of_div : forall a b x y, R a x -> R b y -> R (div p a b) (div q x y);
  of_opp : forall a x, R a x -> R (opp p a) (opp q x);
  of_idle : forall f g, R (f tt) (g tt) -> R (idle p f) (idle q g)
}.

Definition pair {A B} (R : A -> B -> Prop) (a : A * A) (b : B * B) : Prop := R (fst a) (fst b) /\ R (snd a) (snd b).

Lemma dual_related p q R : related p q R -> related (dual p) (dual q) (pair R).
Proof.
  intros [w a s m d n i]; split; unfold pair; cbn; intros;
    repeat match goal with H : _ /\ _ |- _ => destruct H end; split; auto 8.
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

(* How often a prime divides a number. *)
Fixpoint valuation (fuel : nat) (prime z : Z) : nat :=
  match fuel with
  | 0 => 0
  | S m => if (z =? 0)%Z || negb (Z.modulo z prime =? 0)%Z then 0 else S (valuation m prime (Z.div z prime))
  end.

(* What may stand below: polynomials, each with a prime that divides its value at the point once, and no other's value. *)
Record below := { polynomials : list poly; point : list Z; primes : list Z }.

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

(* A fraction; or none, for what isn't known. *)
Definition frac := option (poly * powers).
Section Fractions.
Variable l : below.
Definition lifted (p : poly) (d : powers) : poly :=
  if forallb (Nat.eqb 0) d then p else pmul p (under_ (polynomials l) d).
Definition made (p : poly) (d : powers) : frac := if peq p (pc 0) then Some (pc 0, []) else Some (p, d).
Definition linear (op : poly -> poly -> poly) (f g : frac) : frac :=
  match f, g with
  | Some (p, d), Some (q, e) => made (op (lifted p (lack d e)) (lifted q (lack e d))) (plus_ d (lack d e))
  | _, _ => None
  end.
Definition fmul (f g : frac) : frac :=
  match f, g with Some (p, d), Some (q, e) => made (pmul p q) (plus_ d e) | _, _ => None end.
Definition fopp (f : frac) : frac := match f with Some (p, d) => Some (popp p, d) | None => None end.
Definition factors (q : poly) : powers :=
  let z := at_point (point l) q in map (fun prime => valuation 40 prime z) (primes l).
Definition fdiv (f g : frac) : frac :=
  match f, g with
  | Some (p, d), Some (q, e) =>
      let s := factors q in let whole_ := under_ (polynomials l) s in
      if peq q whole_ then made (lifted p e) (plus_ d s)
      else if peq q (popp whole_) then made (popp (lifted p e)) (plus_ d s) else None
  | _, _ => None
  end.
Definition fractions : ops := {|
  T := frac; whole z := Some (pc z, []); add := linear padd; sub := linear psub; mul := fmul; div := fdiv; opp := fopp;
  idle _ := None
|}.
Definition alike (f g : frac) : bool :=
  match f, g with Some (p, d), Some (q, e) => peq (lifted p (lack d e)) (lifted q (lack e d)) | _, _ => false end.
Definition var (j : positive) : frac := Some (px j, []).
End Fractions.

Section Field.
Variable K : Type.
Variables (k0 k1 : K) (kadd kmul ksub kdiv : K -> K -> K) (kopp kinv : K -> K).
Variable theory : field_theory k0 k1 kadd kmul ksub kopp kdiv kinv (@eq K).
Add Field field_of_K : theory.
Definition phi := gen_phiZ k0 k1 kadd kmul kopp.
Definition numbers : ops := {|
  T := K; whole := phi; add := kadd; sub := ksub; mul := kmul; div := kdiv; opp := kopp; idle f := f tt
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

(* A fraction stands for a number, none for any. *)
Definition means (f : frac) (x : K) : Prop := match f with Some (p, d) => ev p = kmul x (under d) | None => True end.
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
  intros ok spread; destruct f as [[p d] |], g as [[q e] |]; cbn [linear]; unfold means at 1 2; auto; try (cbn; auto; fail).
  intros hp hq; apply means_made; rewrite ok, !ev_lifted, hp, hq, spread; apply f_equal2.
  - rewrite under_plus; ring.
  - rewrite lack_both, under_plus; ring.
Qed.
Lemma mul_ok f g x y : means f x -> means g y -> means (fmul f g) (kmul x y).
Proof.
  destruct f as [[p d] |], g as [[q e] |]; cbn [fmul]; unfold means at 1 2; try (cbn; auto; fail).
  intros hp hq; apply means_made; rewrite ev_mul, under_plus, hp, hq; ring.
Qed.
Lemma opp_ok f x : means f x -> means (fopp f) (kopp x).
Proof. destruct f as [[p d] |]; cbn; auto; intro hp; rewrite ev_opp, hp; ring. Qed.
Lemma div_ok f g x y : means f x -> means g y -> means (fdiv l f g) (kdiv x y).
Proof.
  destruct f as [[p d] |], g as [[q e] |]; cbn [fdiv]; unfold means at 1 2; try (cbn; auto; fail).
  intros hp hq; set (s := factors l q); cbn zeta; fold (under s).
  destruct (peq q _) eqn:z; [| destruct (peq q (popp _)) eqn:n; [| cbn; auto]].
  - apply ev_eq in z; fold (under s) in z; apply means_made.
    assert (y <> k0) by (intro w; apply (under_not s); rewrite <- z, hq, w; ring).
    rewrite ev_lifted, under_plus, hp, <- z, hq; field; auto.
  - apply ev_eq in n; rewrite ev_opp in n; fold (under s) in n; apply means_made.
    assert (m : under s = kopp (kmul y (under e))) by (rewrite <- hq, n; ring).
    assert (y <> k0) by (intro w; apply (under_not s); rewrite m, w; ring).
    rewrite ev_opp, ev_lifted, under_plus, hp, m; field; auto.
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
  - intros; exact I.
Qed.
Lemma var_ok j : means (var j) (BinList.nth k0 j env).
Proof. cbn -[px]; rewrite ev_x; unfold under; rewrite nothing; ring. Qed.
Lemma alike_ok f g x y : means f x -> means g y -> alike l f g = true -> x = y.
Proof.
  destruct f as [[p d] |], g as [[q e] |]; cbn; try discriminate; intros hp hq s; apply ev_eq in s.
  rewrite !ev_lifted, hp, hq in s; apply (cancel x y (under (plus_ d (lack d e)))); [apply under_not |].
  transitivity (kmul (kmul x (under d)) (under (lack d e))); [rewrite under_plus; ring |].
  rewrite s, lack_both, under_plus; ring.
Qed.
Lemma all_alike a x : Forall2 means a x -> forall b y, Forall2 means b y ->
  length a = length b -> forallb (fun p => alike l (fst p) (snd p)) (combine a b) = true -> x = y.
Proof.
  induction 1 as [| f u a x hf _ IH]; intros b y [| g v b' y' hg hb]; simpl; try discriminate; auto.
  rewrite andb_true_iff; intros n [s r]; f_equal; [exact (alike_ok _ _ _ _ hf hg s) | apply (IH b'); auto].
Qed.
End Field.
